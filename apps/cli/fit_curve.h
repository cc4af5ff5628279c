#pragma once

#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/budget/fit.h"
#include "session.h"

namespace fovea::cli {

Json to_json(const FitPoint& point);

/// What any number of bytes would give, and what some gave.
struct FitCurve {
  std::string title;  ///< Of the model.
  std::int64_t view_size = 512;
  std::vector<FitPoint> chosen;
  std::vector<FitPoint> way;  ///< From the original down.
  std::vector<FitPoint> all;  ///< Those that were measured beside it; empty unless all were.
};

/// A page that stands for itself: likeness over bytes as a curve, a picture of every few points, `picture`
/// PNG files of points of the way, and the numbers as a table.
struct CurvePicture {
  std::size_t point = 0;
  std::vector<std::uint8_t> png;
};
std::string curve_page(const FitCurve& curve, const std::vector<CurvePicture>& pictures);

/// Of up to eight points of the way, evenly over the logarithm of their bytes.
std::vector<CurvePicture> curve_pictures(BudgetFit& fit, const std::vector<FitPoint>& way, Context& context);

}  // namespace fovea::cli
