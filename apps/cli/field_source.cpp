#include "field_source.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "fovea/base/error.h"
#include "fovea/io/field_file.h"

namespace fovea::cli {

namespace {

bool is_file(const std::string& source) {
  constexpr std::array<const char*, 3> kExtensions{".npy", ".csv", ".txt"};
  const std::filesystem::path path(source);
  std::error_code ignored;
  // A misspelt file should be missed as a file, not as an attribute.
  return std::find(kExtensions.begin(), kExtensions.end(), path.extension()) != kExtensions.end() ||
         std::filesystem::is_regular_file(path, ignored);
}

}  // namespace

std::vector<VertexField> load_fields(const std::string& source, const std::string& option, const Model& model,
                                     const ReadOptions& options) {
  const bool file = is_file(source);
  try {
    return file ? field_from_source_order(model, read_field(source, options.max_file_bytes))
                : field_from_attribute(model, source);
  } catch (const Error& error) {
    if (!error.place().empty()) throw;
    throw error.within(file ? source : option);
  }
}

}  // namespace fovea::cli
