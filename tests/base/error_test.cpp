#include "fovea/base/error.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace fovea {
namespace {

constexpr ErrorKind kKinds[] = {ErrorKind::internal, ErrorKind::usage,       ErrorKind::input,
                                ErrorKind::format,   ErrorKind::unsupported, ErrorKind::limit,
                                ErrorKind::output,   ErrorKind::cancelled};

TEST(Error, WhatIsPlaceAndMessage) {
  const Error e(ErrorKind::format, "bad index", "/meshes/0", "repair it");
  EXPECT_STREQ(e.what(), "/meshes/0: bad index");
  EXPECT_EQ(e.kind(), ErrorKind::format);
  EXPECT_EQ(e.message(), "bad index");
  EXPECT_EQ(e.place(), "/meshes/0");
  EXPECT_EQ(e.hint(), "repair it");
}

TEST(Error, WhatIsTheMessageWithoutAPlace) {
  EXPECT_STREQ(Error(ErrorKind::usage, "no target").what(), "no target");
}

TEST(Error, WithinPutsTheFileBeforeThePlace) {
  const Error e = Error(ErrorKind::limit, "too large", "/images/1", "raise it").within("a.glb");
  EXPECT_STREQ(e.what(), "a.glb: /images/1: too large");
  EXPECT_EQ(e.kind(), ErrorKind::limit);
  EXPECT_EQ(e.hint(), "raise it");
  EXPECT_EQ(Error(ErrorKind::limit, "too large").within("a.glb").place(), "a.glb");
}

TEST(Error, EachKindHasItsOwnExitCodeAndName) {
  std::set<int> codes;
  std::set<std::string> names;
  for (const ErrorKind kind : kKinds) {
    codes.insert(exit_code(kind));
    names.insert(to_string(kind));
  }
  EXPECT_EQ(codes, (std::set<int>{1, 2, 3, 4, 5, 6, 7, 130}));
  EXPECT_EQ(names.size(), std::size(kKinds));
}

}  // namespace
}  // namespace fovea
