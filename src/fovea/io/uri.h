#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

/// The content of a data URI.
struct DataUri {
  std::string mime_type;  ///< As declared, in lower case; may be empty.
  std::vector<std::byte> bytes;
};

/// Whether `uri` begins with "data:" (in any case).
bool is_data_uri(std::string_view uri);

/// Decodes a data URI: base64 (padding optional, white space ignored) or percent-encoded; never more
/// bytes than the text has. Throws Error(format) without a place.
DataUri decode_data_uri(std::string_view uri);

/// Base64 in the standard alphabet, padded.
std::string encode_base64(std::span<const std::uint8_t> bytes);

/// Resolves %XX. Throws Error(format) without a place for a "%" without two hexadecimal digits.
std::string percent_decode(std::string_view text);

/// The path, relative to a folder, that a relative URI reference means: percent-decoded, "." and ".."
/// resolved, UTF-8 with "/". Throws Error(format) without a place if it has a scheme, is absolute, is
/// empty, leaves the folder or holds a NUL.
std::string relative_path_of_uri(std::string_view uri);

}  // namespace fovea
