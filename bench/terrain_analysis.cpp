#include "terrain_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fovea/model/image_error.h"

namespace fovea::bench {

namespace {

constexpr std::size_t kAhead = 3;  // rungs to a step, at most

/// As the paper writes it: of the coarser mesh and the coarser texture the one that loses less, whatever
/// either saves.
Path prune_by_step(const JointLadders& ladders) {
  const auto point = [&](const Rungs& rungs) {
    return JointPoint{rungs, ladders.bytes(rungs), ladders.loss(rungs)};
  };
  Path path{point({0, 0})};
  while (true) {
    std::optional<JointPoint> best;
    for (std::size_t l = 0; l < 2; ++l) {
      Rungs rungs = path.back().rungs;
      if (++rungs[l] == ladders.rungs[l]) continue;
      const JointPoint next = point(rungs);
      if (!best || next.loss < best->loss) best = next;
    }
    if (!best) return path;
    path.push_back(*best);
  }
}

/// Loss of the hull at a number of bytes, linear between its points.
double hull_loss(const Path& hull, std::uint64_t bytes) {
  if (bytes >= hull.front().bytes) return hull.front().loss;
  for (std::size_t i = 1; i < hull.size(); ++i) {
    if (bytes < hull[i].bytes) continue;
    const double t =
        static_cast<double>(bytes - hull[i].bytes) / static_cast<double>(hull[i - 1].bytes - hull[i].bytes);
    return hull[i].loss + t * (hull[i - 1].loss - hull[i].loss);
  }
  return hull.back().loss;
}

/// The least loss within a number of bytes; none if nothing is so small.
std::optional<double> least_loss(const Path& points, double bytes) {
  std::optional<double> least;
  for (const JointPoint& p : points) {
    if (static_cast<double>(p.bytes) <= bytes && (!least || p.loss < *least)) least = p.loss;
  }
  return least;
}

/// How far a way stays behind, in dB.
struct Gap {
  double most = 0, mean = 0;
};
Gap gap_to_hull(const Path& path, const Path& hull) {
  Gap gap;
  for (const JointPoint& p : path) {
    const double db = psnr(hull_loss(hull, p.bytes)) - psnr(p.loss);
    gap.most = std::max(gap.most, db);
    gap.mean += db / static_cast<double>(path.size());
  }
  return gap;
}
/// Over budgets in geometric progression: the best pair that was drawn against the best of all.
Gap gap_within_budgets(const Path& drawn, const Path& all) {
  constexpr int kBudgets = 100;
  const auto [low, high] = std::ranges::minmax(all, {}, [](const JointPoint& p) { return p.bytes; });
  Gap gap;
  for (int i = 0; i < kBudgets; ++i) {
    const double bytes =
        static_cast<double>(low.bytes) *
        std::pow(static_cast<double>(high.bytes) / static_cast<double>(low.bytes), i / (kBudgets - 1.0));
    const double db = psnr(*least_loss(all, bytes * 1.000001)) - psnr(*least_loss(drawn, bytes * 1.000001));
    gap.most = std::max(gap.most, db);
    gap.mean += db / kBudgets;
  }
  return gap;
}

}  // namespace

TerrainAnalysis::TerrainAnalysis(const Ladders& ladders, std::vector<std::vector<double>> losses)
    : ladders_(ladders), losses_(std::move(losses)) {
  joint_.rungs = {ladders.meshes.size(), ladders.textures.size()};
  joint_.bytes = [this](const Rungs& r) {
    return ladders_.meshes[r[0]].bytes + ladders_.textures[r[1]].bytes;
  };
  joint_.loss = [this](const Rungs& r) {
    asked_.insert(r);
    return losses_[r[0]][r[1]];
  };
  all_ = exhaust(joint_);
  hull_ = lower_hull(all_);
  add("pruning, by step", [&] { return prune_by_step(joint_); });
  add("pruning, by byte", [&] { return prune(joint_, 0); });
  add(fmt::format("pruning, by byte, up to {} rungs", kAhead), [&] {
    return prune(joint_, 0, std::array{kAhead, kAhead});
  });
  add("growing, by byte", [&] { return grow(joint_, ~std::uint64_t{0}); });
  // As fit.h has it.
  ways_.push_back({fmt::format("hull of what pruning by up to {} drew", kAhead), lower_hull(ways_[2].drawn),
                   ways_[2].drawn});
}

void TerrainAnalysis::print() const {
  fmt::print(
      "| way | pairs drawn | of all | points | behind the hull: most, dB | mean | within bytes: most, dB | "
      "mean |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|\n"
      "| all pairs | {} | 100 % | {} | 0 | 0 | 0 | 0 |\n",
      all_.size(), hull_.size());
  for (const Way& way : ways_) {
    const Gap hull = gap_to_hull(way.path, hull_), within = gap_within_budgets(way.drawn, all_);
    fmt::print("| {} | {} | {:.1f} % | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", way.name,
               way.drawn.size(),
               100.0 * static_cast<double>(way.drawn.size()) / static_cast<double>(all_.size()),
               way.path.size(), hull.most, hull.mean, within.most, within.mean);
  }
  fmt::print(
      "\n| bytes | best pair: mesh, texture | dB | pruning by up to 3 rungs: mesh, texture | dB "
      "|\n|--:|--:|--:|--:|--:|\n");
  const auto bytes = [](const Path& points, double most) {
    const JointPoint* best = nullptr;
    for (const JointPoint& p : points) {
      if (static_cast<double>(p.bytes) <= most && (best == nullptr || p.loss < best->loss)) best = &p;
    }
    return best;
  };
  const double high = static_cast<double>(all_.front().bytes);
  for (const double part : {0.5, 0.25, 0.125, 0.0625, 0.03125}) {
    const JointPoint *best = bytes(all_, part * high), *found = bytes(ways_[2].drawn, part * high);
    if (best == nullptr || found == nullptr) continue;
    fmt::print("| {:.0f} | {}, {} | {:.2f} | {}, {} | {:.2f} |\n", part * high,
               ladders_.meshes[best->rungs[0]].bytes, ladders_.textures[best->rungs[1]].bytes,
               psnr(best->loss), ladders_.meshes[found->rungs[0]].bytes,
               ladders_.textures[found->rungs[1]].bytes, psnr(found->loss));
  }
  fmt::print("\n");
}

std::array<std::pair<std::string, JointPoint>, 3> TerrainAnalysis::trades(double part) const {
  const double most = part * static_cast<double>(all_.front().bytes);
  const auto best = std::ranges::min_element(all_, {}, [&](const JointPoint& p) {
    return static_cast<double>(p.bytes) <= most ? p.loss : std::numeric_limits<double>::max();
  });
  const auto most_for = [&](bool is_texture) {
    return *std::ranges::max_element(all_, {}, [&](const JointPoint& p) -> std::uint64_t {
      const double bytes = static_cast<double>(p.bytes) / static_cast<double>(best->bytes);
      if (bytes < 0.95 || bytes > 1.05) return 0;
      return is_texture ? ladders_.textures[p.rungs[1]].bytes : ladders_.meshes[p.rungs[0]].bytes;
    });
  };
  return {{{"fine-texture", most_for(true)}, {"best", *best}, {"fine-mesh", most_for(false)}}};
}

void TerrainAnalysis::write_points(std::ofstream& out, const std::string& land) const {
  for (const JointPoint& p : all_) {
    std::string passed;
    const auto passes = [&](const Path& path) {
      return std::ranges::any_of(path, [&](const JointPoint& q) { return q.rungs == p.rungs; });
    };
    for (const Way& way : ways_) passed += passes(way.path) ? ",1" : ",0";
    out << fmt::format("{},{},{},{},{},{},{},{:.6g},{:.4f},{}{}\n", land,
                       ladders_.name.substr(0, ladders_.name.find(',')), p.rungs[0], p.rungs[1],
                       ladders_.meshes[p.rungs[0]].bytes, ladders_.textures[p.rungs[1]].bytes, p.bytes,
                       p.loss, psnr(p.loss), passes(hull_) ? 1 : 0, passed);
  }
}

void TerrainAnalysis::add(std::string name, const std::function<Path()>& walk) {
  asked_.clear();
  Path path = walk();
  Path drawn;
  for (const Rungs& r : asked_) drawn.push_back({r, joint_.bytes(r), losses_[r[0]][r[1]]});
  ways_.push_back({std::move(name), std::move(path), std::move(drawn)});
}

}  // namespace fovea::bench
