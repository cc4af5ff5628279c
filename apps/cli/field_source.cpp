#include "field_source.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "fovea/base/text.h"
#include "fovea/io/field_file.h"

namespace fovea::cli {

namespace {

bool is_file(const std::string& source) {
  constexpr std::array<const char*, 3> kExtensions{".npy", ".csv", ".txt"};
  std::error_code ignored;
  // A misspelt file should be missed as a file, not as an attribute.
  return std::find(kExtensions.begin(), kExtensions.end(), lower_extension(source)) != kExtensions.end() ||
         std::filesystem::is_regular_file(source, ignored);
}

}  // namespace

NamedFields load_fields(const std::string& source, const Input& input, const ReadOptions& options) {
  if (!is_file(source))
    return {about(input.path, [&] { return field_from_attribute(input.model, source); }), input.path};
  const std::vector<float> values = read_field(source, options.max_file_bytes);
  return {about(source, [&] { return field_from_source_order(input.model, values); }), source};
}

}  // namespace fovea::cli
