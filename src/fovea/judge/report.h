#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/io/write.h"
#include "fovea/judge/compare.h"

namespace fovea {

/// A model as a report shows it.
struct ReportModel {
  std::string name;
  std::uint64_t triangles = 0, vertices = 0;
  ByteCounts bytes;
};

/// One page that shows how models compare with their reference, with everything in it: no other file and no
/// network is needed to read it.
///
/// Collects pictures while `compare` runs (pass `observer()`), then writes the page.
class CompareReport {
 public:
  /// Valid as long as this object. Pictures are kept as WebP.
  CompareObserver observer();

  /// HTML with the models' sizes and scores, a slider between the pictures of each view, FLIP and distance as
  /// heat, and FLIP over the views.
  std::string html(const ReportModel& reference, std::span<const ReportModel> tests,
                   std::span<const Comparison> found) const;

 private:
  struct Shown {
    std::string base_color, lit, flip, distance;  // data URIs
  };
  std::vector<Shown> reference_;           // [#views]
  std::vector<std::vector<Shown>> tests_;  // [#views][#tests]
};

}  // namespace fovea
