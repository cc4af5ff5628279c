#include "fovea/io/extension.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "fovea/base/error.h"
#include "fovea/base/text.h"

namespace fovea {

void check_extension(const std::filesystem::path& path, const std::string& what,
                     const std::vector<std::string>& known) {
  const std::string extension = lower_extension(path);
  if (std::find(known.begin(), known.end(), extension) != known.end()) return;
  throw Error(ErrorKind::usage,
              extension.empty() ? "the name has no extension"
                                : fmt::format("{} are not written as {}", what, extension),
              path.string(), fmt::format("known for {}: {}", what, fmt::join(known, ", ")));
}

}  // namespace fovea
