#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fovea/sample/arm_paint.h"
#include "fovea/sample/builder.h"
#include "fovea/sample/curve.h"
#include "fovea/sample/noise.h"
#include "fovea/sample/sheet.h"

namespace fovea::sample {

namespace {

constexpr double kPi = std::numbers::pi;

// Joints lie on the axis of the arm, which runs along +x with the palm up (+y).
constexpr Vec3d kShoulder{0, 0, 0}, kElbow{1.30, -0.05, 0}, kWrist{2.52, 0, 0};

/// Half of the arm's section, (x, radius): shoulder, sleeve, cuff, forearm, palm.
const Curve& arm_profile() {
  static const Curve kCurve({{-0.29, 0},     {-0.26, 0.13}, {-0.14, 0.265}, {0.05, 0.315},  {0.30, 0.302},
                             {0.60, 0.278},  {0.85, 0.250}, {1.10, 0.218},  {1.30, 0.208},  {1.50, 0.216},
                             {1.70, 0.208},  {1.82, 0.206}, {1.89, 0.213},  {1.915, 0.205}, {1.910, 0.185},
                             {1.895, 0.172}, {1.95, 0.167}, {2.15, 0.140},  {2.40, 0.108},  {2.55, 0.103},
                             {2.68, 0.120},  {2.85, 0.158}, {3.00, 0.165},  {3.09, 0.140},  {3.13, 0.070},
                             {3.135, 0}});
  return kCurve;
}
constexpr double kCuff = 15, kPalmEnd = 25;

/// A body around a nearly straight axis: profile radius × flattening, bent upwards.
struct Limb {
  Vec3d origin, axis, up;      ///< Unit vectors; sections lie across `axis`.
  std::vector<Vec2d> profile;  ///< Distance along the axis, radius.
  double seam_rad = kPi;       ///< Where columns begin, counted from `up`.
  double bend = 0;             ///< Lift at the end, growing with the square of the way.
  /// Scales of the section's height and width at a distance along the axis.
  std::function<Vec2d(double)> flatten = [](double) { return Vec2d{1, 1}; };
  /// What is added to the radius at a distance and an angle from `up`.
  std::function<double(double, double)> relief = [](double, double) { return 0.0; };
};

Sheet limb_sheet(const Limb& limb, int columns, const Chart& chart) {
  Sheet sheet;
  sheet.columns = columns;
  sheet.rows = static_cast<int>(limb.profile.size()) - 1;
  sheet.position = [&limb, columns](int column, int row) {
    const Vec2d p = limb.profile[static_cast<std::size_t>(row)];
    const double angle = limb.seam_rad + 2 * kPi * (column % columns) / columns;
    const double way = p.x / limb.profile.back().x;
    const double radius = p.y > 0 ? p.y + limb.relief(p.x, angle) : 0;
    const Vec2d scale = limb.flatten(p.x);
    const Vec3d side = cross(limb.axis, limb.up);
    return limb.origin + limb.axis * p.x + limb.up * (limb.bend * way * way) +
           limb.up * (radius * scale.x * std::cos(angle)) + side * (radius * scale.y * std::sin(angle));
  };
  sheet.uv = [columns, rows = sheet.rows, chart](int column, int row) {
    return chart.uv(static_cast<double>(column) / columns, static_cast<double>(row) / rows, ArmAtlas::kSize,
                    ArmAtlas::kSize);
  };
  return sheet;
}

double bump(double x, double middle, double width) {
  const double d = (x - middle) / width;
  return std::exp(-d * d);
}

/// Muscles, the elbow's tip, and folds of the sleeve.
double arm_relief(double x, double angle) {
  const double up = std::cos(angle), side = std::sin(angle);
  double r = 0.045 * bump(x, 0.62, 0.30) * std::max(0.0, up) - 0.012 * bump(x, 1.08, 0.15) * up;
  r += 0.030 * bump(x, 1.33, 0.10) * std::max(0.0, -up) + 0.022 * bump(x, 1.62, 0.22) * std::abs(side);
  const double sleeve = smooth_step(1.80, 1.65, x) * smooth_step(-0.25, 0.1, x);
  const double folds = 0.35 + bump(x, 1.28, 0.22) + 0.7 * bump(x, 0.05, 0.2);
  const Vec3d p{9 * x + 1.5 * up, 1.1 * up, 1.1 * side};
  return r + 0.012 * sleeve * folds * fractal_noise(p, 2, 41);
}

/// The hand is flat and wide.
Vec2d arm_flatten(double x) {
  const double hand = smooth_step(2.45, 2.85, x);
  return {mix(1.0, 0.42, hand), mix(1.0, 1.30, hand)};
}

Limb arm_limb(double from, double to, int rows) {
  Limb limb{kShoulder, {1, 0, 0}, {0, 1, 0}, arm_profile().even(from, to, rows)};
  limb.flatten = arm_flatten;
  limb.relief = arm_relief;
  return limb;
}

struct FingerShape {
  Vec3d base, direction;
  double length, radius, bend;
};
constexpr std::array<FingerShape, ArmAtlas::kFingers> kFingerShapes{{
    {{3.02, 0.0, -0.150}, {1, 0, -0.13}, 0.36, 0.043, 0.07},
    {{3.05, 0.0, -0.052}, {1, 0, -0.03}, 0.46, 0.047, 0.09},
    {{3.05, 0.0, 0.050}, {1, 0, 0.05}, 0.49, 0.048, 0.09},
    {{3.02, 0.0, 0.150}, {1, 0, 0.15}, 0.44, 0.047, 0.07},
    {{2.72, 0.015, 0.10}, {0.72, 0.12, 0.69}, 0.40, 0.054, 0.03},
}};

Limb finger_limb(const FingerShape& shape, int rows) {
  const double l = shape.length, r = shape.radius;
  const Curve profile({{-0.09, 0},
                       {-0.08, 0.8 * r},
                       {0.0, 1.08 * r},
                       {0.24 * l, 0.98 * r},
                       {0.42 * l, 1.06 * r},
                       {0.58 * l, 0.92 * r},
                       {0.70 * l, 0.96 * r},
                       {0.86 * l, 0.84 * r},
                       {0.95 * l, 0.62 * r},
                       {0.99 * l, 0.30 * r},
                       {l, 0}});
  const Vec3d axis = normalized(shape.direction);
  const Vec3d up = normalized(Vec3d{0, 1, 0} - axis * axis.y);
  Limb limb{shape.base, axis, up, profile.even(0, 10, rows)};
  limb.seam_rad = 0;  // On the palm's side, so that the nail is whole.
  limb.bend = shape.bend;
  return limb;
}

VertexArray four_wide(Semantic semantic, Storage storage) {
  VertexArray a;
  a.semantic = semantic;
  a.width = 4;
  a.storage = storage;
  return a;
}

/// Influences along x: each joint passes to the next over a stretch around it.
void add_influences(SplitPart& part) {
  VertexArray joints = four_wide(Semantic::joints, {ComponentType::u8, false});
  VertexArray weights = four_wide(Semantic::weights, {});
  for (const Vec3f& p : part.positions) {
    const double elbow = smooth_step(kElbow.x - 0.30, kElbow.x + 0.30, p.x);
    const double wrist = smooth_step(kWrist.x - 0.14, kWrist.x + 0.14, p.x);
    const int first = wrist > 0 ? 1 : 0;  // The two stretches do not overlap.
    const auto second_weight = static_cast<float>(wrist > 0 ? wrist : elbow);
    const float first_weight = 1 - second_weight;
    // glTF: a joint without weight is joint 0.
    joints.values.insert(joints.values.end(),
                         {first_weight > 0 ? static_cast<float>(first) : 0.0f,
                          second_weight > 0 ? static_cast<float>(first + 1) : 0.0f, 0, 0});
    weights.values.insert(weights.values.end(), {first_weight, second_weight, 0, 0});
  }
  part.attributes.push_back(std::move(joints));
  part.attributes.push_back(std::move(weights));
}

SplitPart arm_part(const ArmAtlas& atlas, double detail, int material) {
  SplitPart part = make_part(material);
  const int columns = scaled(96, detail);
  const Limb sleeve = arm_limb(0, kCuff, scaled(100, detail));
  const Limb skin = arm_limb(kCuff, kPalmEnd, scaled(56, detail));
  add_sheet(part, limb_sheet(sleeve, columns, atlas.sleeve));
  add_sheet(part, limb_sheet(skin, columns, atlas.skin));
  for (int i = 0; i < ArmAtlas::kFingers; ++i) {
    const Limb finger = finger_limb(kFingerShapes[static_cast<std::size_t>(i)], scaled(28, detail));
    add_sheet(part, limb_sheet(finger, scaled(24, detail), atlas.finger(i)));
  }
  add_normals(part);
  add_influences(part);
  return part;
}

/// Joints as a chain of nodes; returns the first.
int add_skeleton(Model& model) {
  const std::array<const char*, 3> names{"shoulder", "elbow", "wrist"};
  const std::array<Vec3d, 3> places{kShoulder, kElbow, kWrist};
  const int first = static_cast<int>(model.nodes.size());
  Skin skin;
  skin.name = "arm";
  std::vector<float> inverse_bind;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Node node;
    node.name = names[i];
    node.translation = i > 0 ? places[i] - places[i - 1] : places[i];
    const int index = first + static_cast<int>(i);
    if (i + 1 < places.size()) node.children = {index + 1};
    model.nodes.push_back(std::move(node));
    skin.joints.push_back(index);
    for (const double x : affine_inverse(compose(places[i], {}, {1, 1, 1})).m) {
      inverse_bind.push_back(static_cast<float>(x));
    }
  }
  skin.inverse_bind = Accessor::from_floats(inverse_bind, 16);
  skin.inverse_bind->matrix = true;
  model.skins.push_back(std::move(skin));
  model.scenes[0].nodes.push_back(first);
  return first;
}

/// The elbow bends to 120 degrees and back, slowly at both ends.
void add_bending(Model& model, int elbow) {
  constexpr int kKeys = 24;
  constexpr double kSeconds = 3, kMost = 120 * kPi / 180;
  std::vector<float> times, rotations;
  for (int i = 0; i <= kKeys; ++i) {
    const double phase = static_cast<double>(i) / kKeys;
    const double half = kMost * 0.5 * (1 - std::cos(2 * kPi * phase)) * 0.5;
    times.push_back(static_cast<float>(kSeconds * phase));
    rotations.insert(rotations.end(),
                     {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))});
  }
  add_animation(model, "bend", elbow, "rotation", times, rotations, 4);
}

}  // namespace

Model make_arm(double detail, Context& context) {
  const ArmAtlas atlas;
  const ArmMeasure measure{arm_profile().length(0, kCuff), arm_profile().length(kCuff, kPalmEnd)};
  Model model = empty_model("arm");
  const int material =
      add_material(model, {"arm", ImageFormat::jpeg, 0.75}, paint_arm(atlas, measure, context));
  context.advance_or_throw("sample", 0.5);
  const int node = add_mesh(model, "arm", {arm_part(atlas, detail, material)}, context);
  const int shoulder = add_skeleton(model);
  model.nodes[static_cast<std::size_t>(node)].skin = 0;
  add_bending(model, shoulder + 1);
  return model;
}

}  // namespace fovea::sample
