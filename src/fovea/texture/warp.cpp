#include "fovea/texture/warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/parallel.h"

namespace fovea {

namespace {

/// Rows of nodes that a thread takes at once.
constexpr std::size_t kNodeRowGrain = 16;
/// Of a cell's area: what a corner's triangle has to keep.
constexpr double kLeastCorner = 0.02;
/// Part of the way to its neighbours that a node relaxes in a round; all of it lets neighbours change places
/// for ever.
constexpr double kStep = 0.8;

double dot(Vec2d a, Vec2d b) { return a.x * b.x + a.y * b.y; }

/// Importance at the resolution of a grid, looked up between its cells' middles. Coordinates in cells.
class ImportanceMap {
 public:
  ImportanceMap(const ImageF& image, int columns, int rows, double floor)
      : columns_(columns),
        rows_(rows),
        values_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    double greatest = 0;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double value = mean(image, i, j);
        values_[index(i, j)] = value;
        greatest = std::max(greatest, value);
      }
    }
    for (double& value : values_) value = greatest > 0 ? floor + (1 - floor) * value / greatest : 1;
  }

  double at(Vec2d p) const {
    const double x = std::clamp(p.x - 0.5, 0.0, columns_ - 1.0), y = std::clamp(p.y - 0.5, 0.0, rows_ - 1.0);
    const int i = std::min(static_cast<int>(x), std::max(columns_ - 2, 0));
    const int j = std::min(static_cast<int>(y), std::max(rows_ - 2, 0));
    const int right = std::min(i + 1, columns_ - 1), below = std::min(j + 1, rows_ - 1);
    const double a = x - i, b = y - j;
    return (1 - b) * ((1 - a) * values_[index(i, j)] + a * values_[index(right, j)]) +
           b * ((1 - a) * values_[index(i, below)] + a * values_[index(right, below)]);
  }

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  }

  /// Over the texels that a cell covers, by how much of each; cells may be smaller than texels.
  double mean(const ImageF& image, int i, int j) const {
    const double left = static_cast<double>(i) * image.width / columns_,
                 right = static_cast<double>(i + 1) * image.width / columns_,
                 top = static_cast<double>(j) * image.height / rows_,
                 bottom = static_cast<double>(j + 1) * image.height / rows_;
    double sum = 0, area = 0;
    for (int y = static_cast<int>(top); y < std::min(bottom, static_cast<double>(image.height)); ++y) {
      for (int x = static_cast<int>(left); x < std::min(right, static_cast<double>(image.width)); ++x) {
        const double part = (std::min(right, x + 1.0) - std::max(left, static_cast<double>(x))) *
                            (std::min(bottom, y + 1.0) - std::max(top, static_cast<double>(y)));
        sum += part * static_cast<double>(*image.at(x, y));
        area += part;
      }
    }
    return area > 0 ? sum / area : 0;
  }

  int columns_, rows_;
  std::vector<double> values_;
};

/// The nodes of one level while they move; coordinates in cells.
class Moving {
 public:
  Moving(const WarpGrid& start, const ImageF& importance, const WarpOptions& options)
      : columns_(start.columns()),
        rows_(start.rows()),
        options_(options),
        importance_(importance, columns_, rows_, options.floor) {
    for (int j = 0; j <= rows_; ++j)
      for (int i = 0; i <= columns_; ++i)
        at_.push_back({start.node(i, j).x * columns_, start.node(i, j).y * rows_});
    relaxed_ = next_ = at_;
    weight_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    square_.resize(weight_.size());
  }

  /// The farthest that a node went.
  double round(const Context& context) {
    over_cells(context, [&](int i, int j) { weight_[cell(i, j)] = importance_.at(center(at_, i, j)); });
    over_nodes(context, [&](int i, int j) { relaxed_[index(i, j)] = relaxed(i, j); });
    over_cells(context, [&](int i, int j) { square_[cell(i, j)] = square_in(i, j); });
    over_nodes(context, [&](int i, int j) {
      const Vec2d asked = on_border(i, j, asked_for(i, j));
      next_[index(i, j)] = relaxed_[index(i, j)] * (1 - options_.rigidity) + asked * options_.rigidity;
    });
    join();
    unfold(context);
    double farthest = 0;
    for (std::size_t n = 0; n < at_.size(); ++n)
      farthest = std::max(farthest, dot(next_[n] - at_[n], next_[n] - at_[n]));
    std::swap(at_, next_);
    return std::sqrt(farthest);
  }

  WarpGrid grid() const {
    WarpGrid result(columns_, rows_);
    for (int j = 0; j <= rows_; ++j)
      for (int i = 0; i <= columns_; ++i)
        result.set_node(i, j, {at_[index(i, j)].x / columns_, at_[index(i, j)].y / rows_});
    return result;
  }

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_ + 1) + static_cast<std::size_t>(i);
  }

  std::size_t cell(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
  }

  template <class Body>
  void over_nodes(const Context& context, const Body& body) {
    parallel_for(context, static_cast<std::size_t>(rows_ + 1), kNodeRowGrain,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t j = begin; j < end; ++j)
                     for (int i = 0; i <= columns_; ++i) body(i, static_cast<int>(j));
                 });
  }

  template <class Body>
  void over_cells(const Context& context, const Body& body) {
    parallel_for(context, static_cast<std::size_t>(rows_), kNodeRowGrain,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t j = begin; j < end; ++j)
                     for (int i = 0; i < columns_; ++i) body(i, static_cast<int>(j));
                 });
  }

  /// Calls `visit(a, b)` for nodes across from each other on borders that are joined, and whether they slide
  /// up and down.
  template <class Visit>
  void over_joined(const Visit& visit) const {
    for (int j = 0; options_.joined_u && j <= rows_; ++j) visit(index(0, j), index(columns_, j), true);
    for (int i = 0; options_.joined_v && i <= columns_; ++i) visit(index(i, 0), index(i, rows_), false);
  }

  void join() {
    over_joined([&](std::size_t a, std::size_t b, bool vertical) {
      double &x = vertical ? next_[a].y : next_[a].x, &y = vertical ? next_[b].y : next_[b].x;
      x = y = (x + y) / 2;
    });
  }

  /// The border may be slid along, not left.
  Vec2d on_border(int i, int j, Vec2d p) const {
    if (i == 0 || i == columns_) p.x = i;
    if (j == 0 || j == rows_) p.y = j;
    return p;
  }

  Vec2d center(const std::vector<Vec2d>& nodes, int i, int j) const {
    return (nodes[index(i, j)] + nodes[index(i + 1, j)] + nodes[index(i, j + 1)] +
            nodes[index(i + 1, j + 1)]) *
           0.25;
  }

  /// Calls `visit(di, dj)` for the cells (i + di, j + dj) around a node.
  template <class Visit>
  void over_cells_around(int i, int j, const Visit& visit) const {
    for (int dj = j > 0 ? -1 : 0; dj <= (j < rows_ ? 0 : -1); ++dj)
      for (int di = i > 0 ? -1 : 0; di <= (i < columns_ ? 0 : -1); ++di) visit(di, dj);
  }

  /// A step down equation 12: each cell around a node pulls it along two of its sides.
  Vec2d relaxed(int i, int j) const {
    const Vec2d here = at_[index(i, j)];
    Vec2d pull{};
    double weights = 0;
    over_cells_around(i, j, [&](int di, int dj) {
      const double weight = weight_[cell(i + di, j + dj)];
      const Vec2d along = at_[index(i + 2 * di + 1, j)], across = at_[index(i, j + 2 * dj + 1)];
      pull = pull + (along - here + across - here) * weight;
      weights += 2 * weight;
    });
    return on_border(i, j, here + pull * (kStep / weights));
  }

  /// A square of the regular grid's size, placed as one.
  struct Square {
    Vec2d center, half_side;  // from the middle to the middle of its right side
  };

  /// That fits a relaxed cell best (equations 15 to 18).
  Square square_in(int i, int j) const {
    constexpr std::array<Vec2d, 4> kSquare{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
    const std::array<Vec2d, 4> is{relaxed_[index(i, j)], relaxed_[index(i + 1, j)],
                                  relaxed_[index(i + 1, j + 1)], relaxed_[index(i, j + 1)]};
    const Vec2d middle = center(relaxed_, i, j);
    double along = 0, across = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      along += dot(kSquare[k], is[k] - middle);
      across += cross(kSquare[k], is[k] - middle);
    }
    const double length = std::sqrt(along * along + across * across);
    return {middle, length > 0 ? Vec2d{along, across} * (0.5 / length) : Vec2d{0.5, 0}};
  }

  /// The mean of where the squares of the cells around a node have it.
  Vec2d asked_for(int i, int j) const {
    Vec2d sum{};
    int count = 0;
    over_cells_around(i, j, [&](int di, int dj) {
      const Square& square = square_[cell(i + di, j + dj)];
      const double x = -2 * di - 1, y = -2 * dj - 1;  // the corner, of a square from -1 to 1
      const Vec2d h = square.half_side;
      sum = sum + square.center + Vec2d{x * h.x - y * h.y, x * h.y + y * h.x};
      ++count;
    });
    return sum * (1.0 / count);
  }

  /// Twice the area of the triangles that the corners of cell (i, j) make with their neighbours.
  std::array<double, 4> corners(const std::vector<Vec2d>& nodes, int i, int j) const {
    const std::array<Vec2d, 4> is{nodes[index(i, j)], nodes[index(i + 1, j)], nodes[index(i + 1, j + 1)],
                                  nodes[index(i, j + 1)]};
    std::array<double, 4> result{};
    for (std::size_t k = 0; k < 4; ++k) result[k] = cross(is[(k + 1) % 4] - is[k], is[(k + 3) % 4] - is[k]);
    return result;
  }

  /// Corners may be sharp if they do not get sharper.
  bool is_sound(int i, int j) const {
    const std::array<double, 4> now = corners(next_, i, j);
    if (*std::min_element(now.begin(), now.end()) >= kLeastCorner) return true;
    const std::array<double, 4> before = corners(at_, i, j);
    for (std::size_t k = 0; k < 4; ++k) {
      if (now[k] < kLeastCorner && now[k] < before[k]) return false;
    }
    return true;
  }

  /// Halves the moves of the corners of cells that would fold, the last time to nothing. That ends: without
  /// moves no cell folds, as none did before.
  void unfold(const Context& context) {
    constexpr int kHalvings = 6;
    std::vector<std::uint8_t> halve(at_.size());
    for (int n = 0;; ++n) {
      std::fill(halve.begin(), halve.end(), std::uint8_t{0});
      bool any = false;
      for (int j = 0; j < rows_; ++j) {
        for (int i = 0; i < columns_; ++i) {
          if (is_sound(i, j)) continue;
          any = true;
          for (const std::size_t node : {index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)})
            halve[node] = 1;
        }
      }
      if (!any) return;
      over_joined([&](std::size_t a, std::size_t b, bool) { halve[a] = halve[b] = halve[a] | halve[b]; });
      const double part = n < kHalvings ? 0.5 : 0;
      over_nodes(context, [&](int i, int j) {
        const std::size_t at = index(i, j);
        if (halve[at] != 0) next_[at] = at_[at] + (next_[at] - at_[at]) * part;
      });
    }
  }

  int columns_, rows_;
  const WarpOptions& options_;
  ImportanceMap importance_;
  std::vector<Vec2d> at_, relaxed_, next_;  // of nodes
  std::vector<double> weight_;              // of cells
  std::vector<Square> square_;
};

void check_importance(const ImageF& importance) {
  if (importance.width < 1 || importance.height < 1 || importance.channels != 1)
    throw Error(ErrorKind::usage, "importance is an image of one channel");
  for (const float x : importance.pixels) {
    if (!(x >= 0) || !std::isfinite(x)) throw Error(ErrorKind::usage, "importance is finite and 0 or more");
  }
}

WarpGrid refined(const WarpGrid& grid, int columns, int rows) {
  WarpGrid result(columns, rows);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      result.set_node(i, j, grid.source({static_cast<double>(i) / columns, static_cast<double>(j) / rows}));
  return result;
}

/// Barycentric weights of the corners of a triangle at p.
std::array<double, 3> weights_at(Vec2d p, Vec2d a, Vec2d b, Vec2d c) {
  const double area = cross(b - a, c - a);
  const double of_b = cross(p - a, c - a) / area, of_c = cross(b - a, p - a) / area;
  return {1 - of_b - of_c, of_b, of_c};
}

}  // namespace

WarpGrid::WarpGrid(int columns, int rows) : columns_(columns), rows_(rows) {
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      nodes_.push_back({static_cast<double>(i) / columns, static_cast<double>(j) / rows});
}

Vec2d WarpGrid::source(Vec2d target) const {
  const double x = std::clamp(target.x, 0.0, 1.0) * columns_, y = std::clamp(target.y, 0.0, 1.0) * rows_;
  const int i = std::min(static_cast<int>(x), columns_ - 1), j = std::min(static_cast<int>(y), rows_ - 1);
  const double a = x - i, b = y - j;
  const Vec2d p = node(i, j), q = node(i + 1, j + 1);
  if (a >= b) return p * (1 - a) + node(i + 1, j) * (a - b) + q * b;
  return p * (1 - b) + node(i, j + 1) * (b - a) + q * a;
}

double WarpGrid::smallest_corner() const {
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      const std::array<Vec2d, 4> is{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
      for (std::size_t k = 0; k < 4; ++k)
        least = std::min(least, cross(is[(k + 1) % 4] - is[k], is[(k + 3) % 4] - is[k]));
    }
  }
  return least * columns_ * rows_;
}

InverseWarp::InverseWarp(const WarpGrid& grid) : grid_(grid) {
  const int columns = grid.columns(), rows = grid.rows();
  const auto fields = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  // Counted first, then filled.
  std::vector<std::uint32_t> count(fields + 1);
  const auto over_fields = [&](int i, int j, const auto& visit) {
    double left = 1, right = 0, top = 1, bottom = 0;
    for (const Vec2d p :
         {grid.node(i, j), grid.node(i + 1, j), grid.node(i, j + 1), grid.node(i + 1, j + 1)}) {
      left = std::min(left, p.x), right = std::max(right, p.x);
      top = std::min(top, p.y), bottom = std::max(bottom, p.y);
    }
    const auto field = [](double x, int n) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
    for (int y = field(top, rows); y <= field(bottom, rows); ++y)
      for (int x = field(left, columns); x <= field(right, columns); ++x)
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x));
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) over_fields(i, j, [&](std::size_t f) { ++count[f + 1]; });
  for (std::size_t f = 0; f < fields; ++f) count[f + 1] += count[f];
  begin_ = count;
  cell_.resize(count.back());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      over_fields(i, j,
                  [&](std::size_t f) { cell_[count[f]++] = static_cast<std::uint32_t>(j * columns + i); });
}

Vec2d InverseWarp::target(Vec2d source) const {
  const int columns = grid_.columns(), rows = grid_.rows();
  const Vec2d p{std::clamp(source.x, 0.0, 1.0), std::clamp(source.y, 0.0, 1.0)};
  const int x = std::min(static_cast<int>(p.x * columns), columns - 1),
            y = std::min(static_cast<int>(p.y * rows), rows - 1);
  const auto field =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
  // The triangle that p is in, or by rounding in none: then the one that it is least outside of.
  double best = -std::numeric_limits<double>::infinity();
  Vec2d result = p;
  for (std::uint32_t k = begin_[field]; k < begin_[field + 1] && best < 0; ++k) {
    const int i = static_cast<int>(cell_[k]) % columns, j = static_cast<int>(cell_[k]) / columns;
    const Vec2d a = grid_.node(i, j), c = grid_.node(i + 1, j + 1);
    const auto consider = [&](Vec2d b, Vec2d corner, bool flip) {
      const auto w = flip ? weights_at(p, a, c, b) : weights_at(p, a, b, c);
      const double inside = std::min({w[0], w[1], w[2]});
      if (inside <= best) return;
      best = inside;
      const Vec2d in_cell = flip ? Vec2d{1, 1} * w[1] + corner * w[2] : corner * w[1] + Vec2d{1, 1} * w[2];
      result = {(i + in_cell.x) / columns, (j + in_cell.y) / rows};
    };
    consider(grid_.node(i + 1, j), {1, 0}, false);
    consider(grid_.node(i, j + 1), {0, 1}, true);
  }
  return {std::clamp(result.x, 0.0, 1.0), std::clamp(result.y, 0.0, 1.0)};
}

OptionList describe(WarpOptions& o) {
  return {
      {"warp-cells", "Cells of the grid along the longer side of a texture.", &o.cells, "", 1, 4096},
      {"warp-rigidity", "How much cells keep their shape, 0 for relaxation alone.", &o.rigidity, "", 0, 1},
      {"warp-floor", "Least importance as a part of the greatest: how far the dull may shrink.", &o.floor, "",
       0.01, 1},
      {"warp-rounds", "Rounds on each level of the grid, at most.", &o.rounds, "", 0, 100000},
      {"warp-tolerance", "A level has settled when no node moves farther, in cells.", &o.tolerance, "", 0, 1},
  };
}

Warp warp(const ImageF& importance, const WarpOptions& options, Context& context) {
  WarpOptions checked = options;
  check(describe(checked));
  check_importance(importance);
  const int longer = std::max(importance.width, importance.height);
  const auto cells = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(options.cells) * side / longer)));
  };
  const int columns = cells(importance.width), rows = cells(importance.height);
  constexpr int kCoarsest = 8;
  int level = 0;
  while (std::max(columns, rows) >> level > kCoarsest) ++level;

  Warp result;
  result.grid = WarpGrid(std::max(columns >> level, 1), std::max(rows >> level, 1));
  result.settled = true;
  for (const int levels = level + 1; level >= 0; --level) {
    result.grid = refined(result.grid, std::max(columns >> level, 1), std::max(rows >> level, 1));
    Moving moving(result.grid, importance, options);
    bool settled = false;
    for (std::int64_t n = 0; n < options.rounds && !settled; ++n) {
      context.advance_or_throw("warp", 1 - (level + 1.0) / (levels + 1.0));
      result.last_move = moving.round(context);
      settled = result.last_move <= options.tolerance;
      ++result.rounds;
    }
    result.settled = result.settled && settled;
    result.grid = moving.grid();
  }
  return result;
}

}  // namespace fovea
