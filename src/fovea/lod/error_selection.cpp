#include "fovea/lod/error_selection.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/base/wide.h"
#include "fovea/lod/step_shapes.h"

namespace fovea {

namespace {

constexpr std::uint32_t kHalf = 1u << 16;
constexpr float kMost = std::numeric_limits<float>::max();

}  // namespace

struct ErrorSelection::Scene {
  StepShapes shapes;
  StepEye eye;
};

ErrorSelection::ErrorSelection(const Model& original, const MultiTessellation& levels,
                               const Importance& importance, const ErrorSelectionOptions& options)
    : levels_(levels),
      scene_(new Scene{make_step_shapes(original, levels, importance), {}}),
      unseen_(static_cast<float>(options.unseen)),
      taken_(levels.step_count()),
      on_screen_(levels.step_count()),
      with_all_(levels.step_count()),
      counts_(kHalf) {
  if (!(options.unseen >= 0 && options.unseen <= 1))
    throw Error(ErrorKind::usage, "what errors out of sight count for is a share, 0 to 1", "unseen");
  find_makers();
}

ErrorSelection::~ErrorSelection() = default;

void ErrorSelection::find_makers() {
  std::vector<std::uint32_t> maker(levels_.first_vertex.back(), kInvalid);
  for (std::uint32_t s = 0; s < levels_.step_count(); ++s) {
    const CollapseStep& step = levels_.record.steps[s];
    const bool merges = step.kind == StepKind::collapse;
    if (!merges) {
      makers_.push_back({kInvalid, kInvalid});
      continue;
    }
    std::uint32_t& of_kept = maker[levels_.vertex(step.mesh, step.kept)];
    makers_.push_back({maker[levels_.vertex(step.mesh, step.removed)], of_kept});
    of_kept = s;
  }
}

void ErrorSelection::begin(const LevelCamera& camera, const LevelBudget& budget) {
  scene_->eye = StepEye(camera);
  error_px_ = static_cast<float>(std::max(0.0, budget.error_px));
  to_remove_ = levels_.triangles - std::min(levels_.triangles, budget.triangles);
  std::ranges::fill(counts_, 0);
  bound_ = 0;
  done_ = 0;
}

bool ErrorSelection::advance(std::size_t work) {
  const std::size_t count = levels_.step_count(), total = total_work();
  const std::size_t end = work < total - done_ ? done_ + work : total;
  while (done_ < end) {
    const std::size_t pass = done_ / count, first = done_ - pass * count;
    const std::size_t last = std::min(end - pass * count, count);
    if (pass == 0) look(first, last);
    if (pass == 1) look_closer(first, last);
    if (pass == 2) take(first, last);
    done_ = pass * count + last;
  }
  return done_ == total;
}

/// Sees steps, raises them to what they need, and counts them by the upper half of their bits.
void ErrorSelection::look(std::size_t begin, std::size_t end) {
  see(scene_->shapes, scene_->eye, begin, end, on_screen_.data());
  for (std::size_t s = begin; s < end; ++s) {
    const bool is_seen = !std::signbit(on_screen_[s]);
    float error = is_seen ? on_screen_[s] : -unseen_ * on_screen_[s];
    // Only what is locked is infinite.
    error = std::isinf(scene_->shapes.error[s]) ? scene_->shapes.error[s] : std::min(error, kMost);
    float with_all = error;
    for (const std::uint32_t needed : levels_.needs_of(s)) with_all = std::max(with_all, with_all_[needed]);
    if (is_seen) {
      for (const std::uint32_t needed : levels_.needs_of(s)) error = std::max(error, on_screen_[needed]);
    }
    for (const std::uint32_t maker : makers_[s]) {
      if (maker == kInvalid) continue;
      with_all = std::max(with_all, with_all_[maker]);
      error = std::max(error, on_screen_[maker]);
    }
    with_all_[s] = with_all;
    if (scene_->shapes.takes_more[s] != 0) error = with_all;
    on_screen_[s] = error;
    counts_[std::bit_cast<std::uint32_t>(error) / kHalf] += levels_.removed_by(s);
  }
  if (end < levels_.step_count()) return;
  upper_ = find_bound(std::bit_cast<std::uint32_t>(kMost) / kHalf + 1);
  std::ranges::fill(counts_, 0);
}

/// Counts steps by the lower half of their bits, of those whose upper half is the bound's.
void ErrorSelection::look_closer(std::size_t begin, std::size_t end) {
  for (std::size_t s = begin; s < end; ++s) {
    const auto bits = std::bit_cast<std::uint32_t>(on_screen_[s]);
    if (bits / kHalf == upper_) counts_[bits % kHalf] += levels_.removed_by(s);
  }
  if (end < levels_.step_count()) return;
  if (to_remove_ > 0) bound_ = std::bit_cast<float>(upper_ * kHalf + find_bound(kHalf));
  bound_ = std::max(bound_, error_px_);
}

/// The first of `count` numbers with which enough triangles are gone, or the last; those gone before it are
/// taken off `to_remove_`.
std::uint32_t ErrorSelection::find_bound(std::uint32_t count) {
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    if (counts_[i] >= to_remove_) return i;
    to_remove_ -= counts_[i];
  }
  return count - 1;
}

/// Takes what is below the bound, and of what is on it the first steps, which need none after them, until
/// enough triangles are gone.
void ErrorSelection::take(std::size_t begin, std::size_t end) {
  for (std::size_t s = begin; s < end; ++s) {
    const float error = on_screen_[s];
    const bool is_last = error == bound_ && error > error_px_;
    taken_.set(s, error <= bound_ && (!is_last || to_remove_ > 0));
    if (is_last) to_remove_ -= std::min<std::uint64_t>(to_remove_, levels_.removed_by(s));
  }
}

}  // namespace fovea
