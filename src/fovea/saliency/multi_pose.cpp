#include "fovea/saliency/multi_pose.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/base/error.h"

namespace fovea {

VertexField multi_pose_base(std::span<const VertexField> poses) {
  if (poses.empty()) throw Error(ErrorKind::usage, "there are no poses to combine");
  VertexField base = poses.front();
  for (std::size_t p = 1; p < poses.size(); ++p) {
    if (poses[p].size() != base.size()) {
      throw Error(ErrorKind::usage,
                  fmt::format("pose {} has {} values but the first has {}", p, poses[p].size(), base.size()),
                  {}, "poses must be of the same vertices");
    }
    const std::span<const float> values = poses[p].values();
    for (std::size_t v = 0; v < values.size(); ++v) base.values()[v] = std::min(base.values()[v], values[v]);
  }
  return base;
}

VertexField multi_pose_saliency(std::span<const VertexField> poses) {
  VertexField result = multi_pose_base(poses);
  for (std::size_t v = 0; v < result.size(); ++v) {
    const double base = result.values()[v];
    double sum = base;
    for (const VertexField& pose : poses) sum += pose.values()[v] - base;
    result.values()[v] = static_cast<float>(sum);
  }
  return result;
}

}  // namespace fovea
