#include "fovea/budget/mesh_ladder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fovea/simplify/simplify.h"

namespace fovea {

namespace {

constexpr double kFewest = 0.005;
/// From so many triangles on pictures decide which go (simplify.h); up to there quadrics do as well.
constexpr double kMostByPictures = 12000;

CollapseRecord simplified(const Model& model, const std::optional<ViewOptions>& cameras, Context& context) {
  const std::uint64_t total = counts(model).triangles;
  SimplifyOptions options;
  options.ratio = kFewest;
  const double fewest = std::max(1.0, kFewest * static_cast<double>(total));
  const double by_pictures = cameras ? static_cast<double>(total) : kMostByPictures;
  if (fewest < by_pictures) {
    options.metric = Metric::image;
    options.metric_from = by_pictures / fewest;
  }
  if (cameras) options.views = *cameras;
  return simplify(model, options, {}, context).record;
}

/// [#meshes] The ladder that each is on; kInvalid for those without triangles.
std::vector<std::uint32_t> ladders_of(const Model& model, bool separate) {
  std::vector<std::uint32_t> ladders;
  std::uint32_t next = 0;
  for (const Mesh& mesh : model.meshes) {
    const bool is_empty = mesh.surface.face_count() == 0;
    ladders.push_back(is_empty ? kInvalid : separate ? next++ : 0);
  }
  return ladders;
}

}  // namespace

MeshLadders::MeshLadders(const Model& model, const MeshLadderOptions& options, const FileForm& form,
                         Context& context)
    : model_(model) {
  if (!options.whole && counts(model).triangles > 0) record_ = simplified(model, options.cameras, context);
  const std::vector<std::uint32_t> ladders = ladders_of(model, options.separate);
  for (std::size_t m = 0; m < ladders.size(); ++m) {
    if (ladders[m] == kInvalid) continue;
    whole_.resize(std::max<std::size_t>(whole_.size(), ladders[m] + 1));
    whole_[ladders[m]] += model.meshes[m].surface.face_count();
  }
  own_.resize(whole_.size());
  removed_.assign(whole_.size(), {0});
  std::uint32_t faces = 0;
  for (std::size_t s = 0; s < record_.steps.size(); ++s) {
    const CollapseStep& step = record_.steps[s];
    const std::uint32_t ladder = ladders[step.mesh];
    own_[ladder].push_back(s);
    removed_[ladder].push_back(removed_[ladder].back() + step.faces_end -
                               std::exchange(faces, step.faces_end));
  }
  const std::uint64_t total = std::accumulate(whole_.begin(), whole_.end(), std::uint64_t{0});
  const double share =
      options.triangles && total > 0
          ? std::min(1.0, static_cast<double>(*options.triangles) / static_cast<double>(total))
          : 1;
  for (std::size_t l = 0; l < whole_.size(); ++l) {
    const auto all = static_cast<double>(whole_[l]);
    std::vector<MeshRung>& rungs = rungs_.emplace_back();
    for (double wanted = share * all;; wanted = std::min(wanted * options.fewer, wanted - 1)) {
      const auto left = static_cast<std::uint64_t>(std::max(wanted, 0.0));
      const std::uint64_t goes = whole_[l] - std::min(left, whole_[l]);
      const auto steps =
          static_cast<std::size_t>(std::ranges::lower_bound(removed_[l], goes) - removed_[l].begin());
      const std::size_t taken = std::min(steps, own_[l].size());
      if (rungs.empty() || taken > rungs.back().steps)
        rungs.push_back({taken, whole_[l] - removed_[l][taken], 0});
      if (wanted < kFewest * all || wanted < 2 || taken == own_[l].size()) break;
    }
  }
  measure(form, context);
}

void MeshLadders::measure(const FileForm& form, Context& context) {
  // One ladder at a time, the others at their ends, where they are soon encoded.
  std::vector<std::size_t> ends;
  for (const auto& rungs : rungs_) ends.push_back(rungs.back().steps);
  rest_bytes_ = written_bytes(level(ends), form, context).rest;
  for (std::size_t l = 0; l < rungs_.size(); ++l) {
    std::vector<std::size_t> steps = ends;
    std::uint64_t last = 0;
    for (MeshRung& rung : rungs_[l]) {
      steps[l] = rung.steps;
      rung.bytes = written_bytes(level(steps), form, context).rest;
      last = rung.bytes;
    }
    // What a ladder takes is what it takes above its end; the end itself is in the rest.
    for (MeshRung& rung : rungs_[l]) rung.bytes -= std::min(rung.bytes, last);
    // Fewer triangles that take no fewer bytes are of no use.
    std::vector<MeshRung> useful;
    for (const MeshRung& rung : rungs_[l])
      if (useful.empty() || rung.bytes < useful.back().bytes) useful.push_back(rung);
    rungs_[l] = std::move(useful);
  }
}

std::uint64_t MeshLadders::triangles(std::span<const std::size_t> steps) const {
  std::uint64_t sum = 0;
  for (std::size_t l = 0; l < steps.size(); ++l) sum += triangles_after(l, steps[l]);
  return sum;
}

Model MeshLadders::level(std::span<const std::size_t> steps) const {
  std::vector<const TriMesh*> sources;
  for (const Mesh& mesh : model_.meshes) sources.push_back(&mesh.surface);
  std::vector<TriMesh> surfaces;
  if (own_.size() <= 1) {
    surfaces = replay(sources, record_, own_.empty() ? 0 : steps[0]);
  } else {
    std::vector<std::uint8_t> taken(record_.steps.size());
    for (std::size_t l = 0; l < steps.size(); ++l)
      for (std::size_t s = 0; s < steps[l]; ++s) taken[own_[l][s]] = 1;
    surfaces = replay(sources, record_, taken);
  }
  Model result = model_;
  for (std::size_t m = 0; m < surfaces.size(); ++m) {
    // As `simplify` does it: what has no triangles is left as it is.
    if (model_.meshes[m].surface.face_count() > 0) result.meshes[m].surface = std::move(surfaces[m]);
  }
  return result;
}

double MeshLadders::bytes(std::size_t ladder, std::size_t steps) const {
  const std::vector<MeshRung>& rungs = rungs_[ladder];
  const auto below = std::ranges::lower_bound(rungs, steps, {}, &MeshRung::steps);
  if (below == rungs.end()) return static_cast<double>(rungs.back().bytes);
  if (below == rungs.begin()) return static_cast<double>(rungs.front().bytes);
  const MeshRung &more = below[-1], &fewer = *below;
  const double part = static_cast<double>(triangles_after(ladder, steps) - fewer.triangles) /
                      static_cast<double>(std::max<std::uint64_t>(1, more.triangles - fewer.triangles));
  return std::lerp(static_cast<double>(fewer.bytes), static_cast<double>(more.bytes), part);
}

std::size_t MeshLadders::steps_within(std::size_t ladder, double bytes) const {
  std::size_t least = rungs_[ladder].front().steps, most = rungs_[ladder].back().steps;
  while (least < most) {
    const std::size_t middle = least + (most - least) / 2;
    if (this->bytes(ladder, middle) <= bytes) {
      most = middle;
    } else {
      least = middle + 1;
    }
  }
  return least;
}

std::vector<std::size_t> MeshLadders::first_steps(std::size_t count) const {
  std::vector<std::size_t> steps;
  for (std::size_t l = 0; l < own_.size(); ++l) {
    const auto taken = static_cast<std::size_t>(std::ranges::lower_bound(own_[l], count) - own_[l].begin());
    steps.push_back(std::clamp(taken, rungs_[l].front().steps, rungs_[l].back().steps));
  }
  return steps;
}

}  // namespace fovea
