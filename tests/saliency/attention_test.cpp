#include "fovea/saliency/attention.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/base/error.h"
#include "fovea/saliency/attention_law.h"
#include "fovea/saliency/distance_transform.h"
#include "support/meshes.h"

namespace fovea {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// From above, in parallel: the square [0, 1]² fills the picture.
View from_above() {
  View view;
  view.eye = {0.5, 0.5, 5};
  view.perspective = false;
  view.half_height = 0.5;
  return view;
}

AttentionLabels labels_of(const Model& model, const View& view, const std::vector<Focus>& foci,
                          const AttentionOptions& options = {}, double reach = 1e9) {
  Context context;
  const RenderScene scene = make_render_scene(model, rest_pose(model), context);
  return attention_labels(model, scene, view, foci, options, reach, context);
}

/// The best of all ways by steps of 5, 7 and 11: along (2, 1) and an axis, or along (2, 1) and the diagonal.
std::int32_t chamfer(int dx, int dy) {
  dx = std::abs(dx), dy = std::abs(dy);
  if (dx < dy) std::swap(dx, dy);
  return 2 * dy <= dx ? 5 * dx + dy : 4 * dx + 3 * dy;
}

TEST(DistanceTransform, IsTheChamferDistance) {
  const std::vector<GridCell> sources{{3, 20}, {40, 2}, {41, 2}};
  const std::vector<std::int32_t> distance = distance_transform(50, 30, sources);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 50; ++x) {
      std::int32_t least = std::numeric_limits<std::int32_t>::max();
      for (const GridCell& s : sources) least = std::min(least, chamfer(x - s.x, y - s.y));
      EXPECT_EQ(distance[static_cast<std::size_t>(y) * 50 + static_cast<std::size_t>(x)], least)
          << x << " " << y;
    }
  }
}

TEST(DistanceTransform, IsNearTheStraightDistance) {
  const std::vector<GridCell> middle{{50, 50}};
  const std::vector<std::int32_t> distance = distance_transform(101, 101, middle);
  for (int y = 0; y <= 100; ++y) {
    for (int x = 0; x <= 100; ++x) {
      const double straight = 5 * std::hypot(x - 50, y - 50);
      EXPECT_NEAR(distance[static_cast<std::size_t>(y) * 101 + static_cast<std::size_t>(x)], straight,
                  0.021 * straight);
    }
  }
}

TEST(DistanceTransform, WithoutSourcesAllIsFar) {
  for (const std::int32_t d : distance_transform(4, 3, {})) EXPECT_GE(d, 1 << 30);
}

TEST(Attention, LabelsVerticesByTheCellTheyProjectInto) {
  const TriMesh mesh = test::grid(8, 8);
  AttentionOptions options;
  options.view_size = 100;
  const AttentionLabels labels = labels_of(test::model_of(mesh), from_above(), {{30.5, 40.5}}, options);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    // The last row and column lie on the border, half a cell and more beyond the middle of the last cell.
    const int x = std::min(static_cast<int>(mesh.positions[v].x * 100), 99);
    const int y = std::min(static_cast<int>((1 - mesh.positions[v].y) * 100), 99);
    EXPECT_NEAR(labels.attended[0].values()[v], chamfer(x - 30, y - 40), 5) << v;
    EXPECT_EQ(labels.neglected[0].values()[v], kNone);
  }
}

TEST(Attention, OutsideThePictureItGoesOn) {
  View view = from_above();
  view.half_height = 0.25;  // the inner quarter of the square
  AttentionOptions options;
  options.view_size = 100;
  const AttentionLabels labels = labels_of(test::model_of(test::grid(1, 1)), view, {{50, 50}}, options);
  // From the middle to the corner of the picture 50 cells across corners, and as far again: 50 √2 cells.
  for (const float label : labels.attended[0].values())
    EXPECT_NEAR(label, 7 * 50 + 5 * 50 * std::sqrt(2.0), 10);
}

TEST(Attention, NearestFocusCountsByItsWeight) {
  const TriMesh mesh = test::grid(10, 1);
  AttentionOptions options;
  options.view_size = 100;
  const AttentionLabels labels =
      labels_of(test::model_of(mesh), from_above(), {{0, 99}, {99, 99, 3}, {50, 99, -2}}, options);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.positions[v].y > 0) continue;
    const double x = 100 * static_cast<double>(mesh.positions[v].x);
    EXPECT_NEAR(labels.attended[0].values()[v], std::min(5 * x, 5 * (99 - std::min(x, 99.0)) / 3), 5) << x;
    EXPECT_NEAR(labels.neglected[0].values()[v], 5 * std::abs(x - 50) / 2, 5) << x;
  }
}

TEST(Attention, HiddenPartsHaveNoLabelIfOnlyVisibleOnesAreAskedFor) {
  const Model model = test::model_of(test::icosphere(4));
  View view = view_onto({{0, 0, 0}, 1}, {0, 0, 1}, 30, 0);
  AttentionOptions options;
  const AttentionLabels all = labels_of(model, view, {{128, 128}}, options);
  options.visible_only = true;
  const AttentionLabels seen = labels_of(model, view, {{128, 128}}, options);
  options.element = AttentionElement::faces;
  const AttentionLabels faces = labels_of(model, view, {{128, 128}}, options);
  const std::vector<Vec3f>& p = model.meshes[0].surface.positions;
  const double horizon = std::sin(15 * 3.14159265 / 180);  // where lines of sight touch the sphere
  for (std::size_t v = 0; v < p.size(); ++v) {
    EXPECT_NE(all.attended[0].values()[v], kNone);
    const auto z = static_cast<double>(p[v].z);
    if (z > horizon + 0.15) {
      EXPECT_EQ(seen.attended[0].values()[v], all.attended[0].values()[v]);
      EXPECT_NE(faces.attended[0].values()[v], kNone);
    }
    if (z < horizon - 0.15) {
      EXPECT_EQ(seen.attended[0].values()[v], kNone);
      EXPECT_EQ(faces.attended[0].values()[v], kNone);
    }
  }
}

TEST(Attention, LargeTrianglesAreFoundBetweenTheirCorners) {
  const Model model = test::model_of(test::single_triangle());  // (0, 0), (1, 0), (0, 1)
  AttentionOptions options;
  options.view_size = 100;
  const std::vector<Focus> inside{{30, 70}};
  EXPECT_GT(labels_of(model, from_above(), inside, options).attended[0].values()[0], 150);
  options.element = AttentionElement::faces;
  EXPECT_EQ(labels_of(model, from_above(), inside, options).attended[0].values()[0], 0);
}

TEST(Attention, OnTheSurfaceDistancesGoAroundIt) {
  const Model model = test::model_of(test::icosphere(5));
  const View view = view_onto({{0, 0, 0}, 1}, {0, 0, 1}, 30, 0);
  AttentionOptions options;
  options.on_surface = true;
  const AttentionLabels labels = labels_of(model, view, {{128, 128}}, options);
  // Where it is nearest a pixel is (distance − 1) · 2 tan 15° / 256 wide.
  const double distance = 1 / std::sin(15 * 3.14159265358979 / 180);
  const double fifth = (distance - 1) * 2 * std::tan(15 * 3.14159265358979 / 180) / 256 / 5;
  const std::vector<Vec3f>& p = model.meshes[0].surface.positions;
  for (std::size_t v = 0; v < p.size(); v += 17) {
    const double around = std::acos(std::clamp(static_cast<double>(p[v].z), -1.0, 1.0));
    EXPECT_NEAR(labels.attended[0].values()[v] * fifth, around, 0.03) << v;  // facets and the nearest corner
  }
}

TEST(Attention, OnTheSurfaceOtherPiecesAreReachedStraight) {
  TriMesh above = test::grid(4, 4);
  for (Vec3f& p : above.positions) p.z = 0.3f;
  const Model model = test::model_of({test::grid(4, 4), above});
  AttentionOptions options;
  options.on_surface = true;
  options.view_size = 100;  // a fifth of a pixel is 0.002
  const AttentionLabels labels = labels_of(model, from_above(), {{50, 49}}, options, 200);
  for (std::size_t v = 0; v < above.vertex_count(); ++v) {
    const double along = std::hypot(static_cast<double>(above.positions[v].x) - 0.505,
                                    static_cast<double>(above.positions[v].y) - 0.505);
    const auto expect = [&](std::size_t mesh, double distance) {
      const float label = labels.attended[mesh].values()[v];
      if (distance < 0.4) {
        EXPECT_NEAR(label, distance / 0.002, 8)
            << v;  // ways begin at a corner of the triangle under the focus
      } else {
        EXPECT_EQ(label, kNone) << v;
      }
    };
    expect(1, along);
    expect(0, std::hypot(along, 0.3));
  }
}

TEST(Attention, WrongFociAreRefused) {
  const Model model = test::model_of(test::icosphere(2));
  const View view = view_onto({{0, 0, 0}, 1}, {0, 0, 1}, 30, 1);
  EXPECT_THROW(labels_of(model, view, {}), Error);
  EXPECT_THROW(labels_of(model, view, {{256, 10}}), Error);
  EXPECT_THROW(labels_of(model, view, {{10, -1}}), Error);
  EXPECT_THROW(labels_of(model, view, {{10, 10, 0}}), Error);
  AttentionOptions options;
  options.on_surface = true;
  EXPECT_THROW(labels_of(model, view, {{2, 2}}, options), Error);  // beside the sphere
}

/// A mesh of vertices with these labels.
AttentionLabels labels_with(std::vector<float> attended, std::vector<float> neglected) {
  return {{VertexField(std::move(attended))}, {VertexField(std::move(neglected))}};
}

TEST(AttentionLaw, ThresholdAllowsTwoErrors) {
  AttentionLawOptions options;
  options.threshold = 100;
  options.factor = 0.25;
  options.neglect = 3;
  const AttentionLabels labels =
      labels_with({0, 99, 100, kNone, 50, 20, kNone}, {kNone, kNone, kNone, kNone, 40, 40, 150});
  const std::vector<VertexField> shares = allowed_shares(labels, from_above(), 100, options);
  EXPECT_EQ(std::vector<float>(shares[0].values().begin(), shares[0].values().end()),
            (std::vector<float>{0.25f, 0.25f, 1, 1, 3, 0.25f, 1}));
}

TEST(AttentionLaw, LinearGoesFromOneToTheOther) {
  AttentionLawOptions options;
  options.law = AttentionLaw::linear;
  options.threshold = 100;
  options.factor = 0.2;
  options.neglect = 3;
  const AttentionLabels labels = labels_with({0, 50, 100, 500, kNone}, {kNone, kNone, kNone, kNone, 50});
  const std::vector<VertexField> shares = allowed_shares(labels, from_above(), 100, options);
  const std::vector<float> expected{0.2f, 0.6f, 1, 1, 2};
  for (std::size_t v = 0; v < expected.size(); ++v)
    EXPECT_NEAR(shares[0].values()[v], expected[v], 1e-6) << v;
}

TEST(AttentionLaw, AcuityHalvesEveryTwoAndAHalfDegrees) {
  AttentionLawOptions options;
  options.law = AttentionLaw::acuity;
  options.factor = 0.1;
  options.viewing_distance = 2;
  // In a picture 100 pixels high seen from two heights a label of 5 · 200 · tan(a) is at the angle a.
  const auto label = [](double degrees) {
    return static_cast<float>(1000 * std::tan(degrees * 3.14159265358979 / 180));
  };
  const AttentionLabels labels =
      labels_with({0, label(2.5), label(5), label(22.5), label(60)}, {kNone, kNone, kNone, kNone, kNone});
  const std::vector<VertexField> shares = allowed_shares(labels, from_above(), 100, options);
  const std::vector<float> expected{0.1f, 0.2f, 0.3f, 1, 1};
  for (std::size_t v = 0; v < expected.size(); ++v)
    EXPECT_NEAR(shares[0].values()[v], expected[v], 1e-5) << v;
  EXPECT_NEAR(attention_reach(options, from_above(), 100), label(22.5), 1e-2);
}

TEST(AttentionLaw, WhatHasNoAngleIsRefused) {
  AttentionLawOptions options;
  options.law = AttentionLaw::acuity;
  const AttentionLabels labels = labels_with({0}, {kNone});
  EXPECT_THROW(allowed_shares(labels, from_above(), 100, options), Error);  // a parallel view
  options.viewing_distance = 2;
  options.factor = 0;
  EXPECT_THROW(allowed_shares(labels, from_above(), 100, options), Error);
  options.factor = 2;
  EXPECT_THROW(allowed_shares(labels, from_above(), 100, options), Error);
}

TEST(AttentionLaw, ImportanceIsOfSquaredErrors) {
  const std::vector<VertexField> importance = importance_of({VertexField(std::vector<float>{1, 0.5f, 0, 2})});
  EXPECT_EQ(std::vector<float>(importance[0].values().begin(), importance[0].values().end()),
            (std::vector<float>{1, 4, kNone, 0.25f}));
}

}  // namespace
}  // namespace fovea
