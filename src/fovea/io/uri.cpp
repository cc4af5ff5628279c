#include "fovea/io/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>

#include "fovea/io/format_error.h"
#include "fovea/io/gltf_json.h"

namespace fovea {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Value of a base64 digit (standard or URL alphabet); -1 for white space, -2 for anything else.
constexpr std::array<std::int8_t, 256> make_base64_table() {
  std::array<std::int8_t, 256> table{};
  for (auto& value : table) value = -2;
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  }
  table['-'] = 62;
  table['_'] = 63;
  for (const char c : {' ', '\t', '\r', '\n'}) table[static_cast<unsigned char>(c)] = -1;
  return table;
}

std::vector<std::byte> decode_base64(std::string_view text) {
  static constexpr auto kTable = make_base64_table();
  const std::size_t end = text.find_last_not_of("= \t\r\n");
  text = text.substr(0, end == std::string_view::npos ? 0 : end + 1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int digit = kTable[static_cast<unsigned char>(text[i])];
    if (digit == -1) continue;
    if (digit < 0) gltf::fail(fmt::format("character {} of the base64 data is not a base64 digit", i));
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xFF));
    }
  }
  if (bit_count == 6) gltf::fail("the base64 data ends inside a byte");
  return bytes;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.';
  });
}

/// Where the content of a data URI begins: after its first comma.
std::size_t content_begin(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) gltf::fail("a data URI without \",\"");
  return comma + 1;
}

std::filesystem::path utf8_path(const std::string& text) {
  return std::filesystem::path(std::u8string(text.begin(), text.end()));
}

}  // namespace

std::string encode_base64(std::span<const std::uint8_t> bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = i; k < i + 3; ++k) group = group << 8 | (k < bytes.size() ? bytes[k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k > bytes.size() - i ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return uri.size() >= kScheme.size() &&
         std::equal(kScheme.begin(), kScheme.end(), uri.begin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

DataUri decode_data_uri(std::string_view uri) {
  const std::size_t begin = content_begin(uri);
  std::string head(uri.substr(5, begin - 6));
  std::transform(head.begin(), head.end(), head.begin(), [](unsigned char c) { return std::tolower(c); });
  DataUri data;
  data.mime_type = head.substr(0, head.find(';'));
  if (head.ends_with(";base64")) {
    data.bytes = decode_base64(uri.substr(begin));
  } else {
    const std::string text = percent_decode(uri.substr(begin));
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    data.bytes.assign(first, first + text.size());
  }
  return data;
}

std::string percent_decode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
    if (high < 0 || low < 0)
      gltf::fail(fmt::format("\"%\" without two hexadecimal digits in {}", gltf::shown(text)));
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

std::string relative_path_of_uri(std::string_view uri) {
  if (has_scheme(uri))
    gltf::fail(fmt::format("only files beside the model are read, not {}", gltf::shown(uri)));
  const std::string decoded = percent_decode(uri);
  if (decoded.find('\0') != std::string::npos) gltf::fail("a file name with a NUL character");
  const std::filesystem::path path = utf8_path(decoded);
  if (path.is_absolute() || path.has_root_path()) {
    gltf::fail(fmt::format("only files beside the model are read, not {}", gltf::shown(decoded)));
  }
  const std::filesystem::path normal = path.lexically_normal();
  if (normal.empty() || normal == "." || *normal.begin() == "..") {
    gltf::fail(fmt::format("{} is not below the model's folder", gltf::shown(decoded)));
  }
  const std::u8string text = normal.generic_u8string();
  return {text.begin(), text.end()};
}

}  // namespace fovea
