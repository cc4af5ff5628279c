#include "fovea/render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "field_source.h"
#include "fovea/io/image_file.h"
#include "input.h"
#include "report.h"
#include "shared_options.h"
#include "sheet.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

class Render : public Verb {
 public:
  VerbText text() const override {
    return {"render",
            "draw a model from one or many sides",
            "Draws a model with its materials, lit or plain, or numbers that belong to its vertices. Several "
            "views "
            "make a sheet. The same picture on every machine, without a graphics card.",
            {{"fovea render helmet.glb -o helmet.png", "A sheet of 24 views."},
             {"fovea render helmet.glb -o turn.png --views orbit --view-count 8 --columns 8",
              "A turntable strip."},
             {"fovea render fox.glb -o fox.png --view 5 --width 800 --height 600 --animation 0 --time 0.4",
              "One view of an animation's moment."},
             {"fovea render scan.ply -o heat.png --pass field --field importance.npy",
              "Numbers per vertex as a heat map."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add("Views", describe(view_options_));
    arguments.add("Views", {{"view", "Draw this view of the set alone, counted from 1; 0 draws all.", &view_,
                             "", 0, 4096},
                            describe_columns(columns_)});
    arguments.add("Picture", {describe_view_size(size_)});
    OptionList picture = describe(options_);
    for (Option& option : picture) {
      if (option.name != "width" && option.name != "height") continue;
      option.value = option.name == "width" ? &width_ : &height_;
      option.help.insert(option.help.size() - 1, ", instead of --view-size");
    }
    arguments.add("Picture", picture);
    arguments.add("Picture",
                  {{"background", "Colour behind the model, as #RRGGBB.", &background_, "colour"},
                   describe_field("field", "Numbers per vertex for --pass field or region", field_)});
    arguments.add("Picture", describe(pose_options_));
    arguments.add("Output", {describe_output(output_), describe_force(force_)});
    arguments.add("Limits", describe(read_options_));
    need_views(arguments, view_options_);
    arguments.need({{"field"}, "--pass field or region", [&] { return shows_field(); }});
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    session.report["inputs"] = inputs_json({&input, 1});
    need_triangles(input);
    std::vector<VertexField> fields;
    if (!field_.empty()) fields = session.phase("field", [&] { return load_range(input, session); });
    const Pose pose = about(input_, [&] { return pose_of(input.model, pose_options_); });
    const RenderScene scene = session.phase(
        "prepare", input_, [&] { return make_render_scene(input.model, pose, session.context); });
    const std::vector<View> views = about(input_, [&] { return chosen_views(input.model, pose, scene); });
    const Image8 sheet = session.phase(
        "draw", [&] { return draw_sheet(scene, views, columns_, options_, session.context, fields); });
    session.phase("write", [&] { write_image(sheet, output_, force_); });
    tell(session, scene, views, sheet);
    return 0;
  }

 private:
  void check_request() {
    check_input(input_);
    check_output(output_, "picture.png", {input_}, force_,
                 [&](const auto& path) { check_image_output(path, force_); });
    if (shows_field() && field_.empty())
      throw Error(ErrorKind::usage, "--pass field and region need --field", {},
                  "it names the numbers to show");
    options_.width = width_.value_or(size_);
    options_.height = height_.value_or(size_);
    check(pose_options_);
    options_.background = parse_color(background_);
  }

  bool shows_field() const { return options_.pass == Pass::field || options_.pass == Pass::region; }

  static std::array<std::uint8_t, 3> parse_color(const std::string& text) {
    const bool ok = text.size() == 7 && text[0] == '#' &&
                    text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (!ok) {
      throw Error(ErrorKind::usage, fmt::format("\"{}\" is not a colour", printable(text)), "--background",
                  "write #RRGGBB, for example #808080");
    }
    const auto channel = [&](std::size_t at) {
      return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
    };
    return {channel(1), channel(3), channel(5)};
  }

  /// The fields; for heat scaled to [0, 1] over all meshes, what is not a number is 0.
  std::vector<VertexField> load_range(const Input& input, Session& session) {
    std::vector<VertexField> fields = load_fields(field_, input, read_options_).fields;
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const VertexField& field : fields) {
      for (const float x : field.values()) {
        if (!std::isfinite(x)) continue;
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    for (VertexField& field : fields) {
      if (options_.pass == Pass::region) break;  // numbers of regions are shown as they are
      for (float& x : field.values()) x = std::isfinite(x) && high > low ? (x - low) / (high - low) : 0.0f;
    }
    session.report["field"] = {{"source", field_}, {"low", number_json(low)}, {"high", number_json(high)}};
    return fields;
  }

  std::vector<View> chosen_views(const Model& model, const Pose& pose, const RenderScene& scene) const {
    std::vector<View> views = views_of(view_options_, model, pose, scene.sphere);
    if (view_ == 0) return views;
    if (static_cast<std::size_t>(view_) > views.size()) {
      const bool own = view_options_.set == ViewSet::cameras;
      throw Error(own ? ErrorKind::unsupported : ErrorKind::usage,
                  fmt::format("there are only {} views", views.size()), "--view");
    }
    return {views[static_cast<std::size_t>(view_ - 1)]};
  }

  void tell(Session& session, const RenderScene& scene, const std::vector<View>& views,
            const Image8& sheet) const {
    Json& json = session.report["views"] = Json::array();
    for (const View& view : views) {
      json.push_back({{"name", view.name},
                      {"eye", {view.eye.x, view.eye.y, view.eye.z}},
                      {"toward", {-view.back.x, -view.back.y, -view.back.z}}});
    }
    Json output = file_json(output_);
    output.update({{"width", sheet.width}, {"height", sheet.height}});
    session.report["outputs"] = Json::array({output});
    session.report["triangles_drawn"] = scene.triangle_count;
    session.print_summary(fmt::format("{} -> {}\n{} of {}, {} x {} pixels\n{}\n", printable(input_),
                                      printable(output_), plural(views.size(), "view", "views"),
                                      plural(scene.triangle_count, "triangle", "triangles"), sheet.width,
                                      sheet.height, session.spent_text()));
  }

  std::string input_;
  std::string output_;
  std::string field_;
  std::string background_ = "#808080";
  std::int64_t view_ = 0;
  std::int64_t columns_ = 0;
  std::int64_t size_ = 512;
  std::optional<std::int64_t> width_, height_;
  bool force_ = false;
  PoseOptions pose_options_;
  ViewOptions view_options_;
  RenderOptions options_;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_render() { return std::make_unique<Render>(); }

}  // namespace fovea::cli
