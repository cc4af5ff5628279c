#include "words.h"

#include <algorithm>

#include "fovea/base/error.h"

namespace fovea::bench {

std::optional<std::string> take_option(std::vector<std::string>& words, const std::string& name) {
  const auto at = std::ranges::find(words, name);
  if (at == words.end()) return std::nullopt;
  if (at + 1 == words.end()) throw Error(ErrorKind::usage, name + " needs a value");
  std::string value = *(at + 1);
  words.erase(at, at + 2);
  return value;
}

}  // namespace fovea::bench
