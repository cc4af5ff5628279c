#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/base/text.h"
#include "fovea/io/field_file.h"
#include "fovea/io/image_file.h"
#include "fovea/io/write.h"
#include "fovea/lod/cut.h"
#include "fovea/render/heat_map.h"
#include "fovea/render/render.h"
#include "fovea/saliency/attention.h"
#include "fovea/saliency/attention_law.h"
#include "fovea/saliency/attention_region.h"
#include "fovea/simplify/simplify.h"
#include "input.h"
#include "report.h"
#include "shared_options.h"
#include "sheet.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

/// What is written. The first leaves it to the extension of the output.
enum class FocusOutput { by_extension, level, picture, heat, attribute, field };

/// Attributes are finite: as good as a lock.
constexpr float kMostImportance = 1e6f;

class FocusVerb : public Verb {
 public:
  VerbText text() const override {
    return {"focus",
            "keep what somebody looks at, and let the rest go",
            "Reads a model and where somebody looks, in a camera's picture or in the scene, and writes it "
            "with full "
            "detail "
            "there and less with the distance from it: all triangles keep to the error that is allowed where "
            "they "
            "are, and fit together without cracks. Or writes how important that makes each vertex, for other "
            "verbs. Exit code 8 says that more triangles had to stay than were asked for; the output is "
            "written all "
            "the same.",
            {{"fovea focus bunny.ply -o head.glb --view 0,10 --at 90,60 --error 0.01",
              "Within 60 fifths of a pixel of (90, 60) a twentieth of the error of the rest, 1 % of the "
              "diagonal."},
             {"fovea focus bunny.ply -o head.glb --at 90,60 --threshold 178 --factor 0 --ratio 0.1",
              "All detail within 178; a tenth of the triangles in all."},
             {"fovea focus car.glb -o car-look.glb --camera Front --at 120,90 --at 40,100,-1 --law acuity "
              "--error 0.02",
              "As sharp as the eye sees there, and nobody looks at (40, 100)."},
             {"fovea focus car.glb -o door.npy --at 120,130 --on-surface",
              "Importance for \"fovea simplify --importance door.npy\", for views from everywhere."},
             {"fovea focus city.glb -o square.glb --sphere 120,0,-40,25 --factor 0 --error 0.01",
              "As it is within 25 units of a place of the scene, up to 1 % of the diagonal off elsewhere."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add(
        "Attention",
        {{"at",
          "Where somebody looks: X,Y in pixels of the picture from its top left, or X,Y,WEIGHT, by which "
          "distances from it are divided; with a negative weight nobody looks there. May be given many "
          "times.",
          &at_, "x,y[,weight]"},
         {"sphere",
          "A ball of the scene that is looked at closely, with --at or instead: its middle and its radius. "
          "Triangles that reach into it keep to --factor of the error. May be given many times.",
          &sphere_, "x,y,z,radius"},
         {"box", "The same for a box: two opposite corners.", &box_, "x,y,z,x,y,z"}});
    arguments.add("Attention", describe(attention_));
    arguments.add("Attention", describe(law_));
    arguments.add(
        "Camera",
        {{"view",
          "From where: degrees around the upright axis from the front (+z) to the right, and above the "
          "horizon.",
          &view_, "azimuth,elevation"},
         {"eye", "From where: a position in the scene, instead of --view.", &eye_, "x,y,z"},
         {"target", "What --eye looks at; the middle of the model by default.", &target_, "x,y,z"},
         {"camera", "The name of one of the model's own cameras, instead of --view.", &camera_, "name"}});
    const OptionList views = describe(view_options_);
    arguments.add("Camera", {taken(views, "fov", &view_options_.fov_deg),
                             taken(views, "margin", &view_options_.margin)});
    arguments.add("Target", targets());
    arguments.add("Target", {{"allow-miss", "Exit with 0 even if more triangles stay than were asked for.",
                              &allow_miss_, ""}});
    arguments.add(
        "Output",
        {describe_output(output_),
         {"as",
          "What to write: the level, a picture of it from the camera, a heat map of how little error is "
          "allowed, the model with the vertex attribute _IMPORTANCE, or a field of it. By itself as the "
          "extension says: .png, .jpg and .webp are pictures; .npy, .csv and .txt fields; others levels.",
          choice(kind_, {"extension", "level", "picture", "heat", "attribute", "field"}), ""}});
    arguments.add("Output", describe(write_options_));
    arguments.add("Limits", describe(read_options_));
    need_format(arguments, write_options_);
    arguments.need({{"law", "threshold", "neglect", "labels", "visible-only", "on-surface"}, "--at", [&] {
                      return !at_.empty();
                    }});
    arguments.need({{"target"}, "--eye", [&] { return !eye_.empty(); }});
    arguments.need({{"viewing-distance"}, "--law acuity", [&] { return law_.law == AttentionLaw::acuity; }});
    arguments.need({{"labels"}, "the picture, not --on-surface", [&] { return !attention_.on_surface; }});
    arguments.need({{"ratio", "triangles", "error", "error-abs", "allow-miss"},
                    "a level or a picture as output",
                    [&] { return output_.empty() || is_level(); }});
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    const Snapshot before = snapshot(input.model, input.bytes);
    session.report["inputs"] = inputs_json({&input, 1});
    session.report["before"] = to_json(before);
    need_triangles(input);
    const std::vector<VertexField> shares =
        session.phase("attention", input_, [&] { return look(input.model, session); });
    Made made = is_level() ? session.phase("level", input_, [&] { return level(input, shares, session); })
                           : Made{marked(input.model, shares), {}, {}};
    session.phase("write", [&] { write(input.model, made, shares, before, session); });
    session.print_summary(summary_ + fmt::format("time     {}\n", session.spent_text()));
    return is_level() ? target_code(session, made.reached, allow_miss_) : 0;
  }

 private:
  struct Made {
    Model model;
    bool reached = true;
    std::string result;  ///< Lines about it.
  };

  OptionList targets() {
    const OptionList options = describe(simplify_options_);
    OptionList list;
    for (const char* name : {"error", "error-abs"}) {
      list.push_back(taken(options, name, name == std::string("error") ? &error_ : &error_abs_));
      list.back().help =
          name == std::string("error")
              ? "Error that is allowed where nobody looks, as a fraction of the bounding diagonal."
              : "The same in scene units.";
    }
    list.push_back(taken(options, "ratio", &ratio_));
    list.push_back(taken(options, "triangles", &triangles_));
    list[2].help = "Fraction of the triangles to keep; the error that is allowed follows from it.";
    return list;
  }

  void check_request() {
    check_input(input_);
    kind_ = kind();
    check_output(output_, "focus.glb", {input_}, write_options_.force, [&](const auto& path) {
      if (kind_ == FocusOutput::field) return check_field_output(path, write_options_.force);
      if (kind_ == FocusOutput::picture) return check_image_output(path, write_options_.force);
      fovea::check_output(path, write_options_);
    });
    if (at_.empty() && sphere_.empty() && box_.empty()) {
      throw Error(ErrorKind::usage, "nobody looks anywhere", "--at",
                  "give a pixel of the picture, for example --at 128,128 for its middle, or a --sphere or "
                  "--box of the scene");
    }
    for (const std::string& text : at_) {
      const std::vector<double> numbers = parse_numbers("at", text, 2, 3);
      foci_.push_back({numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 1.0});
    }
    for (const std::string& text : sphere_) {
      const std::vector<double> n = parse_numbers("sphere", text, 4, 4);
      if (!(n[3] > 0)) throw Error(ErrorKind::usage, "the radius must be larger than 0", "--sphere " + text);
      regions_.spheres.push_back({{n[0], n[1], n[2]}, n[3]});
    }
    for (const std::string& text : box_) {
      const std::vector<double> n = parse_numbers("box", text, 6, 6);
      Box& box = regions_.boxes.emplace_back();
      box.add({n[0], n[1], n[2]});
      box.add({n[3], n[4], n[5]});
    }
    const int cameras = !view_.empty() + !eye_.empty() + !camera_.empty();
    if (cameras > 1)
      throw Error(ErrorKind::usage, "--view, --eye and --camera are three ways to say the same", {},
                  "give one of them");
    const int given =
        ratio_.has_value() + triangles_.has_value() + error_.has_value() + error_abs_.has_value();
    if (is_level() && given != 1) {
      throw Error(ErrorKind::usage, given == 0 ? "no target is given" : "there is more than one target", {},
                  "give one of --error, --error-abs, --ratio and --triangles, for example --error 0.01");
    }
  }

  bool is_level() const { return kind() == FocusOutput::level || kind() == FocusOutput::picture; }

  FocusOutput kind() const {
    if (kind_ != FocusOutput::by_extension) return kind_;
    const std::string extension = lower_extension(output_);
    const auto is = [&](std::initializer_list<const char*> names) {
      return std::find(names.begin(), names.end(), extension) != names.end();
    };
    if (is({".png", ".jpg", ".jpeg", ".webp"})) return FocusOutput::picture;
    return is({".npy", ".csv", ".txt"}) ? FocusOutput::field : FocusOutput::level;
  }

  View view_of(const Model& model, const Pose& pose, const Sphere& sphere) const {
    if (!camera_.empty()) {
      const std::vector<View> cameras = camera_views(model, pose);
      std::vector<std::string> names;
      for (const View& view : cameras) {
        if (view.name == camera_) return view;
        names.push_back(printable(view.name));
      }
      throw Error(ErrorKind::unsupported, fmt::format("the model has no camera \"{}\"", printable(camera_)),
                  {},
                  names.empty() ? "it has none; use --view or --eye"
                                : fmt::format("it has {}", fmt::join(names, ", ")));
    }
    if (!eye_.empty()) {
      const std::vector<double> eye = parse_numbers("eye", eye_, 3, 3);
      const std::vector<double> target =
          target_.empty() ? std::vector<double>{sphere.center.x, sphere.center.y, sphere.center.z}
                          : parse_numbers("target", target_, 3, 3);
      if (eye == target)
        throw Error(ErrorKind::usage, "the eye is where it looks at", "--eye", "move it away from --target");
      return view_from({eye[0], eye[1], eye[2]}, {target[0], target[1], target[2]}, view_options_.fov_deg);
    }
    const std::vector<double> angles =
        view_.empty() ? std::vector<double>{0, 0} : parse_numbers("view", view_, 2, 2);
    const double around = angles[0] * std::numbers::pi / 180, above = angles[1] * std::numbers::pi / 180;
    return view_onto(
        sphere, {std::sin(around) * std::cos(above), std::sin(above), std::cos(around) * std::cos(above)},
        view_options_.fov_deg, view_options_.margin);
  }

  /// How much of an error is allowed at each vertex.
  std::vector<VertexField> look(const Model& model, Session& session) {
    const Pose pose = rest_pose(model);
    const bool draws = kind_ == FocusOutput::picture;
    const RenderScene scene = make_render_scene(model, pose, session.context, nullptr,
                                                draws ? SceneTextures::all : SceneTextures::none);
    camera_view_ = view_of(model, pose, scene.sphere);
    std::vector<VertexField> shares;
    if (foci_.empty()) {
      for (const Mesh& mesh : model.meshes) shares.emplace_back(mesh.surface.vertex_count(), 1.0f);
    } else {
      const auto size = static_cast<int>(attention_.view_size);
      const double reach = attention_reach(law_, camera_view_, size);
      const AttentionLabels labels =
          attention_labels(model, scene, camera_view_, foci_, attention_, reach, session.context);
      shares = allowed_shares(labels, camera_view_, size, law_);
    }
    if (!regions_.empty() &&
        attend_regions(model, pose, regions_, static_cast<float>(law_.factor), shares) == 0) {
      const Box box = bounds(model);
      throw Error(ErrorKind::usage, "no triangle reaches into the region",
                  sphere_.empty() ? "--box" : "--sphere",
                  fmt::format("the model lies from {},{},{} to {},{},{}", number_text(box.low.x),
                              number_text(box.low.y), number_text(box.low.z), number_text(box.high.x),
                              number_text(box.high.y), number_text(box.high.z)));
    }
    std::uint64_t held = 0;
    for (std::size_t m = 0; m < shares.size(); ++m) {
      for (const auto& t : model.meshes[m].surface.triangles)
        held += std::any_of(t.begin(), t.end(), [&](VertexId v) { return shares[m][v] < 1; });
    }
    session.report["view"] = {{"eye", {camera_view_.eye.x, camera_view_.eye.y, camera_view_.eye.z}},
                              {"toward", {-camera_view_.back.x, -camera_view_.back.y, -camera_view_.back.z}}};
    session.report["triangles_attended"] = held;
    attended_ = fmt::format("attended {} of the original\n", plural(held, "triangle", "triangles"));
    return shares;
  }

  MultiTessellation make_levels(const Model& model, Context& context) const {
    SimplifyOptions options = simplify_options_;
    options.metric = Metric::quadric;
    options.placement = Placement::half_edge;  // needs fewer other steps: detail falls off more steeply
    options.triangles = 0;
    return make_multi_tessellation(model, simplify(model, options, {}, context).record, context);
  }

  /// The coarsest mesh that keeps to what is allowed.
  Made level(const Input& input, const std::vector<VertexField>& shares, Session& session) {
    const Model& model = input.model;
    const double diagonal = bounds(model).diagonal();
    const MultiTessellation levels = input.levels ? *input.levels : make_levels(model, session.context);
    const double error = error_ ? *error_ * diagonal : error_abs_.value_or(diagonal);
    std::vector<float> allowed;
    for (const VertexField& share : shares) {
      for (const float x : share.values())
        allowed.push_back(static_cast<float>(error * static_cast<double>(x)));
    }
    const std::optional<std::uint64_t> most = most_triangles(levels.triangles);
    double factor = 1;
    const Cut cut = most ? cut_within(levels, allowed, *most, &factor) : cut_within(levels, allowed);
    const std::uint64_t left = triangles_of(levels, cut);
    Made made{level_of(model, levels, cut), !most || left <= *most, {}};
    const double elsewhere = factor * error;
    made.result = fmt::format(
        "{}error    {} where nobody looks ({} % of the diagonal), {} of it at the focus\n", attended_,
        number_text(elsewhere), number_text(100 * elsewhere / diagonal), number_text(law_.factor));
    session.report["result"] = {{"triangles_target", most ? Json(*most) : Json()},
                                {"triangles", left},
                                {"reached", made.reached},
                                {"error_abs", number_json(elsewhere)},
                                {"error_rel", number_json(elsewhere / diagonal)}};
    return made;
  }

  std::optional<std::uint64_t> most_triangles(std::uint64_t before) const {
    if (triangles_) return static_cast<std::uint64_t>(*triangles_);
    if (ratio_) return static_cast<std::uint64_t>(std::floor(*ratio_ * static_cast<double>(before) + 1e-9));
    return std::nullopt;
  }

  /// What other outputs than levels are made of; fields need no model.
  Model marked(const Model& model, const std::vector<VertexField>& shares) const {
    if (kind_ == FocusOutput::attribute)
      return with_attribute(model, finite_importance(shares), "_IMPORTANCE");
    if (kind_ != FocusOutput::heat) return {};
    std::vector<VertexField> heat = shares;
    for (VertexField& field : heat) {
      for (float& x : field.values()) x = std::clamp(1 - x, 0.0f, 1.0f);
    }
    return heat_map(model, heat);
  }

  static std::vector<VertexField> finite_importance(const std::vector<VertexField>& shares) {
    std::vector<VertexField> importance = importance_of(shares);
    for (VertexField& field : importance) {
      for (float& x : field.values()) x = std::min(x, kMostImportance);
    }
    return importance;
  }

  void write(const Model& original, const Made& made, const std::vector<VertexField>& shares,
             const Snapshot& before, Session& session) {
    summary_ = fmt::format("{} -> {}\n", printable(input_), printable(output_));
    if (kind_ == FocusOutput::field) {
      write_field(output_, field_in_source_order(original, importance_of(shares)), "importance",
                  write_options_.force);
    } else if (kind_ == FocusOutput::picture) {
      write_image(picture(made.model, session.context), output_, write_options_.force);
    } else {
      const auto files = write_model(made.model, output_, write_options_, session.context);
      const Snapshot after = snapshot(made.model, measure_output(files, made.model));
      session.report["outputs"] = Json::array({file_json(output_, after.bytes)});
      session.report["after"] = to_json(after);
      if (kind_ == FocusOutput::level) summary_ += comparison_text(before, after);
      summary_ += is_level() ? made.result : attended_;
      return;
    }
    session.report["outputs"] = Json::array({file_json(output_)});
    summary_ += is_level()
                    ? fmt::format("triangles {}\n", count_text(counts(made.model).triangles)) + made.result
                    : attended_;
  }

  Image8 picture(const Model& model, Context& context) const {
    RenderOptions options;
    options.width = options.height = attention_.view_size;
    const RenderScene scene = make_render_scene(model, rest_pose(model), context);
    return draw_sheet(scene, {&camera_view_, 1}, 1, options, context, {});
  }

  std::string input_, output_;
  std::vector<std::string> at_, sphere_, box_;
  std::vector<Focus> foci_;
  AttentionRegions regions_;
  std::string view_, eye_, target_, camera_;
  View camera_view_;
  std::string attended_, summary_;
  FocusOutput kind_ = FocusOutput::by_extension;
  bool allow_miss_ = false;
  std::optional<double> ratio_, error_, error_abs_;
  std::optional<std::int64_t> triangles_;
  AttentionOptions attention_;
  AttentionLawOptions law_;
  ViewOptions view_options_;
  SimplifyOptions simplify_options_;
  ReadOptions read_options_;
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_focus() { return std::make_unique<FocusVerb>(); }

}  // namespace fovea::cli
