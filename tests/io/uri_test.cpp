#include "fovea/io/uri.h"

#include <gtest/gtest.h>

#include <cstring>

#include "fovea/base/random.h"

namespace fovea {
namespace {

std::span<const std::uint8_t> bytes_of(const char* text) {
  return {reinterpret_cast<const std::uint8_t*>(text), std::strlen(text)};
}

TEST(Uri, EncodesBase64) {  // RFC 4648, section 10
  EXPECT_EQ(encode_base64(bytes_of("")), "");
  EXPECT_EQ(encode_base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(encode_base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(encode_base64(bytes_of("foobar")), "Zm9vYmFy");
}

TEST(Uri, DecodesWhatItEncodes) {
  Random random(3);
  for (std::size_t size = 0; size < 50; ++size) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(random.below(256)));
    const DataUri decoded = decode_data_uri("data:image/webp;base64," + encode_base64(bytes));
    ASSERT_EQ(decoded.bytes.size(), size);
    EXPECT_TRUE(size == 0 || std::memcmp(decoded.bytes.data(), bytes.data(), size) == 0);
  }
}

}  // namespace
}  // namespace fovea
