#include "importance.h"

namespace fovea::cli {

Importance load_importance(const std::string& source, const Model&) {
  if (source.empty()) return {};
  return {};
}

}  // namespace fovea::cli
