#include "field_source.h"

#include <filesystem>

#include "fovea/io/field_file.h"
#include "map_output.h"

namespace fovea::cli {

namespace {

bool is_file(const std::string& source) {
  std::error_code ignored;
  // A misspelt file should be missed as a file, not as an attribute.
  return is_field_name(source) || std::filesystem::is_regular_file(source, ignored);
}

}  // namespace

NamedFields load_fields(const std::string& source, const Input& input, const ReadOptions& options) {
  if (!is_file(source))
    return {about(input.path, [&] { return field_from_attribute(input.model, source); }), input.path};
  const std::vector<float> values = read_field(source, options.max_file_bytes);
  return {about(source, [&] { return field_from_source_order(input.model, values); }), source};
}

}  // namespace fovea::cli
