#include "fovea/base/text.h"

#include <gtest/gtest.h>

namespace fovea {
namespace {

TEST(Text, LowerCaseIsOfAsciiLettersAlone) { EXPECT_EQ(lower_case("aZ_É9"), "az_É9"); }

TEST(Text, ExtensionsAreWhatComesAfterTheLastDot) {
  EXPECT_EQ(lower_extension("A.b/Model.v2.GLB"), ".glb");
  EXPECT_EQ(lower_extension("A.b/Model"), "");
}

}  // namespace
}  // namespace fovea
