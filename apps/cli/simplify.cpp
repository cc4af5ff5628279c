#include "fovea/simplify/simplify.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "field_source.h"
#include "fovea/budget/fit.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/budget/triangle_search.h"
#include "fovea/io/extension.h"
#include "fovea/io/write.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/auto_metric.h"
#include "fovea/simplify/auto_saliency.h"
#include "fovea/simplify/salient.h"
#include "fovea/texture/shrink.h"
#include "input.h"
#include "report.h"
#include "saliency_source.h"
#include "shared_options.h"
#include "shrink_text.h"
#include "simplify_text.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

enum class Rebake { off, on };

class Simplify : public Verb {
 public:
  VerbText text() const override {
    return {
        "simplify",
        "collapse edges until a target is reached",
        "Reads a model, collapses edges where it shows least, and writes the result with everything else "
        "untouched, or, with --textures, with its images baked anew for what is left of the surface. Of "
        "several targets the first reached stops. Exit code 8 says that the target was not "
        "reached; the output is written all the same, but not if it takes more than --bytes.",
        {{"fovea simplify helmet.glb -o small.glb --ratio 0.1", "Keep 10 % of the triangles."},
         {"fovea simplify scan.ply -o scan.glb --triangles 20000", "Keep 20,000 triangles."},
         {"fovea simplify chair.glb -o chair-lean.glb --error 0.002",
          "As few triangles as an error of 0.2 % of the diagonal allows."},
         {"fovea simplify face.glb -o face-10.glb --ratio 0.1 --importance _IMPORTANCE",
          "Spend the triangles where the vertex attribute _IMPORTANCE is high."},
         {"fovea simplify vase.glb -o vase-small.glb --ratio 0.05 --saliency auto",
          "Try what people look at in several ways and keep what looks best."},
         {"fovea simplify shoe.glb -o shoe-web.glb --ratio 0.05 --best",
          "Try all that Fovea knows and keep what looks best; takes seconds to minutes."},
         {"fovea simplify helmet.glb -o tiny.glb --ratio 0.05 --textures --max-texture 512 --new-normal-maps",
          "Bake the textures for the result, at most 512 texels along a side, and the shape that went "
          "into normal maps."},
         {"fovea simplify helmet.glb -o web.glb --bytes 500KB --textures --quantize",
          "Triangles and texels as 500,000 bytes allow."},
         {"fovea simplify room.glb -o room-web.glb --ratio 0.2 --quantize --compression meshopt",
          "Simplify and store compactly."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    OptionList options = describe(options_);
    const auto metric =
        std::find_if(options.begin(), options.end(), [](const Option& o) { return o.name == "metric"; });
    OptionList views(metric, options.end());
    options.erase(metric, options.end());
    arguments.add("Simplification", options);
    arguments.add(
        "Simplification",
        {describe_bytes("Bytes of the whole .glb or .gltf at most, such as 500KB: as many triangles as "
                        "that allows. With --textures images give way too, so that pictures lose least.",
                        bytes_)});
    arguments.add(
        "Simplification",
        {describe_field("importance", "How much each vertex matters (1 is neutral, more keeps)", importance_),
         {"allow-miss", "Exit with 0 even if the target is not reached.", &allow_miss_, ""}});
    arguments.add(
        "Simplification",
        {{"fast", "By quadrics alone: tenths of a second.", &fast_, ""},
         {"best",
          "Try metrics and what people look at, and keep what looks best: some forty times as long as "
          "without.",
          &best_, ""}});
    OptionList saliency = describe(saliency_options_);
    arguments.add(
        "Saliency",
        {{"saliency",
          "Spend triangles where people look: by a preset of \"fovea saliency\", or by what measures "
          "best on pictures of this model (auto, which takes several times as long and is meant if no "
          "name is given). None by default: over many models no fixed preset measured clearly better.",
          choice(saliency_, saliency_sources(true), "auto"), ""}});
    arguments.add("Saliency", describe(salient_options_));
    std::erase_if(saliency, [](const Option& o) { return o.name != "key-poses" && o.name != "up"; });
    arguments.add("Saliency", saliency);
    arguments.add("Views", views);
    arguments.add(
        "Textures",
        {{"textures",
          "Bake the images anew for the simplified surface, and make them smaller if sizes are given.",
          &textures_, ""},
         {"rebake", "Whether --textures bakes anew, or only makes smaller.", choice(rebake_, {"off", "on"}),
          ""}});
    arguments.add("Textures", describe(shrink_options_.rebake));
    arguments.add("Textures", describe(shrink_options_));
    arguments.add("Warp", describe(shrink_options_.warp));
    arguments.add("Output", {describe_output(output_)});
    arguments.add("Output", describe(write_options_));
    arguments.add("Limits", describe(read_options_));
    declare_needs(arguments);
    arguments.add_hint("ratio", "a ratio is a fraction: 0.1 keeps 10 %");
    arguments.add_hint("error", "an error is a fraction of the diagonal: 0.01 allows 1 %");
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    const Model& model = input.model;
    const Snapshot before = snapshot(model, input.bytes);
    session.report["inputs"] = inputs_json({&input, 1});
    session.report["before"] = to_json(before);
    Importance importance;
    if (!importance_.empty())
      importance = session.phase("importance", [&] { return load_importance(input); });
    if (best_ && before.counts.triangles > 0) {
      options_ =
          session.phase("metric", input_, [&] { return choose_best_metric(model, importance, session); });
    }
    if (saliency_ != SaliencySource::none && before.counts.triangles > 0) {
      importance =
          session.phase("saliency", input_, [&] { return with_saliency(model, importance, session); });
    }
    if (textures_ && rebake_ == Rebake::on) shrink_options_.rebake.original = &model;
    if (textures_ && shrink_options_.max_bytes)
      shrink_options_.lost =
          loss_by_pictures(model, picture_views(), shrink_options_.shown_pixels, session.context);
    const Made made =
        budget_ ? make_within(*budget_, model, importance, session) : make(model, importance, session);
    if (!bytes_reached_ && !allow_miss_) return miss(made, session);
    const auto files = session.phase(
        "write", [&] { return write_model(made.model(), output_, write_options_, session.context); });
    const Snapshot after = snapshot(made.model(), measure_output(files, made.model()));
    return tell(session, before, after, made);
  }

 private:
  /// Where pictures that choose between images look from.
  ViewOptions picture_views() const {
    return options_.views.set == ViewSet::cameras ? options_.views : ViewOptions{};
  }

  void declare_needs(Arguments& arguments) const {
    const auto is = [this](std::initializer_list<Metric> metrics) {
      return std::find(metrics.begin(), metrics.end(), options_.metric) != metrics.end();
    };
    need_format(arguments, write_options_);
    arguments.need({{"metric", "metric-from", "even-exposure", "saliency"},
                    "neither --fast nor --best",
                    [this] { return !fast_ && !best_; },
                    "they say which"});
    need_textures(arguments);
    need_views(arguments, options_.views);
    arguments.need({{"metric-from"}, "--metric image, entropy or polygon-entropy", [is] {
                      return !is({Metric::quadric, Metric::visibility});
                    }});
    arguments.need({{"image-pass", "even-exposure"}, "--metric image", [is] {
                      return is({Metric::automatic, Metric::image});
                    }});
    arguments.need({{"view-size"}, "a --metric by views", [is] { return !is({Metric::quadric}); }});
    arguments.need({{"views", "fov", "margin"}, "a --metric by views, or --cull-hidden", [this, is] {
                      return options_.cull_hidden || !is({Metric::quadric});
                    }});
    arguments.need({{"region-sigma", "region-k", "region-min-size", "region-texels"},
                    "--metric entropy",
                    [is] { return is({Metric::entropy}); }});
    arguments.need({{"key-poses", "up"}, "--saliency", [this] { return saliency_ != SaliencySource::none; }});
    arguments.need({{"saliency-weighting", "saliency-strength"},
                    "a preset of --saliency",
                    [this] { return preset_of(saliency_).has_value(); },
                    "name one, for example --saliency yang; auto finds the strength itself"});
  }

  void need_textures(Arguments& arguments) const {
    ShrinkOptions all;
    std::vector<std::string> names{"rebake"};
    for (const OptionList& list : {describe(all), describe(all.rebake), describe(all.warp)})
      for (const Option& option : list) names.push_back(option.name);
    arguments.need({names, "--textures", [this] { return textures_; }});
    arguments.need({{"new-normal-maps"}, "--rebake on", [this] { return rebake_ == Rebake::on; }});
  }

  void check_request() {
    if (fast_ && best_)
      throw Error(ErrorKind::usage, "--fast and --best are both given", {},
                  "give one, or none for between them");
    if (best_ && options_.per_mesh)
      throw Error(ErrorKind::usage, "--best chooses for all meshes together", "--per-mesh",
                  "leave out one of them");
    if (best_ && !options_.triangles && !options_.ratio)
      throw Error(ErrorKind::usage, "--best chooses for a number of triangles", {},
                  "give --triangles or --ratio, with --bytes or --error if these are to hold, too");
    if (fast_) options_.metric = Metric::quadric;
    if (best_) saliency_ = SaliencySource::chosen;
    if (!options_.triangles && !options_.ratio && !options_.error && !options_.error_abs && bytes_.empty()) {
      throw Error(
          ErrorKind::usage, "no target is given", {},
          "give --ratio, --triangles, --error, --error-abs or --bytes, for example --ratio 0.1 to keep "
          "10 %");
    }
    check_input(input_);
    check_output(output_, "small.glb", {input_}, write_options_.force, [&](const auto& path) {
      if (!bytes_.empty()) check_extension(path, "models of so many bytes", {".glb", ".gltf"});
      fovea::check_output(path, write_options_);
    });
    if (!bytes_.empty()) budget_ = parse_bytes("--bytes", bytes_);
    wants_bytes_alone_ = budget_ && !options_.triangles && !options_.ratio;
    if (budget_ && shrink_options_.max_bytes)
      throw Error(ErrorKind::usage, "--texture-bytes and --bytes are both given", {},
                  "--bytes finds how many of its bytes textures get");
  }

  Importance load_importance(const Input& input) const {
    NamedFields found = load_fields(importance_, input, read_options_);
    about(found.path, [&] { check(found.fields); });
    return std::move(found.fields);
  }

  Importance with_saliency(const Model& model, const Importance& importance, Session& session) {
    if (saliency_ == SaliencySource::chosen) return choose(model, importance, session);
    saliency_options_.preset = *preset_of(saliency_);
    const ModelSaliency found = model_saliency(model, saliency_options_, session.context);
    session.report["saliency"] = {{"textured", found.textured}, {"poses", found.poses}};
    return product(importance, salient_importance(model, found.saliency, salient_options_, session.context));
  }

  SimplifyOptions choose_best_metric(const Model& model, const Importance& importance, Session& session) {
    const AutoMetric found = choose_metric(model, options_, importance, session.context);
    Json trials = Json::array();
    for (const MetricTrial& trial : found.trials)
      trials.push_back({{"name", trial.name}, {"flip", number_json(trial.flip)}});
    session.report["metric"] = {
        {"chosen", found.trials[found.best].name}, {"seconds", found.seconds}, {"trials", std::move(trials)}};
    return found.trials[found.best].options;
  }

  Importance choose(const Model& model, const Importance& importance, Session& session) {
    AutoSaliency found = choose_saliency(model, options_, importance, saliency_options_, session.context);
    Json trials = Json::array();
    for (const SaliencyTrial& trial : found.trials)
      trials.push_back({{"name", trial.name}, {"flip", number_json(trial.flip)}});
    const SaliencyTrial& best = found.trials[found.best];
    session.report["saliency"] = {
        {"chosen", best.name}, {"seconds", found.seconds}, {"trials", std::move(trials)}};
    chosen_ = fmt::format("saliency {} (FLIP {:.4f}, none {:.4f}; {} tried in {})\n", best.name, best.flip,
                          found.trials[0].flip, found.trials.size(), seconds_text(found.seconds));
    return std::move(found.importance);
  }

  /// A model simplified, and its textures made smaller if that is asked for.
  struct Made {
    SimplifyResult simplified;
    std::optional<Shrunk> shrunk;
    const Model& model() const { return shrunk ? shrunk->model : simplified.model; }
  };

  Made make(const Model& model, const Importance& importance, Session& session) {
    Made made;
    made.simplified = session.phase("simplify", input_,
                                    [&] { return simplify(model, options_, importance, session.context); });
    if (textures_) {
      made.shrunk = session.phase("textures", input_, [&] {
        return shrink_textures(made.simplified.model, shrink_options_, {}, session.context);
      });
    }
    return made;
  }

  /// As many triangles as the bytes of the file allow; with textures as many as pictures want of both.
  Made make_within(std::uint64_t bytes, const Model& model, const Importance& importance, Session& session) {
    const FileForm form = file_form(output_, write_options_);
    std::uint64_t most = counts(model).triangles;
    if (options_.triangles) most = std::min(most, static_cast<std::uint64_t>(*options_.triangles));
    if (textures_ && !model.images.empty() && most > 0) {
      const FitPoint split =
          session.phase("split", input_, [&] { return best_split(bytes, model, form, session); });
      shrink_options_.max_bytes = std::max<std::int64_t>(1, static_cast<std::int64_t>(split.image_bytes));
      most = split.triangles;
    }
    std::optional<Made> best, smallest;
    std::uint64_t fewest = 0;
    const auto bytes_at = [&](std::uint64_t triangles) {
      options_.triangles = static_cast<std::int64_t>(triangles);
      Made made = make(model, importance, session);
      Context quiet;
      const std::uint64_t taken = written_bytes(made.model(), form, quiet).total();
      const std::uint64_t left = made.simplified.triangles_after;
      if (taken <= bytes && (!best || left > best->simplified.triangles_after)) {
        best = std::move(made);
      } else if (taken > bytes && (!smallest || taken < fewest)) {
        fewest = taken;
        smallest = std::move(made);
      }
      return taken;
    };
    most_triangles(bytes, most, bytes_at);
    bytes_reached_ = best.has_value();
    return std::move(best ? *best : *smallest);
  }

  /// Nothing is written: what there is is another model.
  int miss(const Made& made, Session& session) const {
    Context quiet;
    const WrittenBytes taken = written_bytes(made.model(), file_form(output_, write_options_), quiet);
    return too_many_bytes(
        session, *budget_, taken.total(),
        textures_ ? "--compression meshopt and --texture-format webp take less"
                  : fmt::format("with --textures images give way too, {} of it", bytes_text(taken.images)));
  }

  FitPoint best_split(std::uint64_t bytes, const Model& model, const FileForm& form, Session& session) const {
    FitOptions fit;
    fit.form = form;
    fit.most_bytes = bytes;
    fit.triangles = options_.triangles;
    fit.format = shrink_options_.output.format;
    return BudgetFit(model, fit, session.context).within(bytes).chosen;
  }

  int tell(Session& session, const Snapshot& before, const Snapshot& after, const Made& made) const {
    const SimplifyResult& result = made.simplified;
    const std::optional<std::int64_t>& most = shrink_options_.max_bytes;
    const bool are_images_small =
        !made.shrunk || budget_ || !most || made.shrunk->bytes <= static_cast<std::uint64_t>(*most);
    const bool has_count = wants_bytes_alone_ || reached_target(result, options_);
    const bool reached = has_count && are_images_small && bytes_reached_;
    std::string texture_text;
    if (made.shrunk) {
      texture_text = tell_shrunk(session, *made.shrunk, rebake_ == Rebake::on);
      if (made.model().images.empty()) texture_text = "textures none\n";
    }
    session.report["outputs"] = Json::array({file_json(output_, after.bytes)});
    session.report["after"] = to_json(after);
    session.report["result"] = result_json(result, options_, reached);
    session.print_summary(fmt::format("{} -> {}\n{}{}{}{}time     {}\n", printable(input_),
                                      printable(output_), comparison_text(before, after),
                                      result_text(result, options_), chosen_, texture_text,
                                      session.spent_text()));
    return target_code(session, reached, allow_miss_);
  }

  std::string input_;
  std::string output_;
  std::string importance_;
  std::string chosen_;  ///< A line about what `auto` chose.
  bool allow_miss_ = false;
  bool fast_ = false, best_ = false;
  bool textures_ = false;
  std::string bytes_;
  std::optional<std::uint64_t> budget_;
  bool bytes_reached_ = true;
  bool wants_bytes_alone_ = false;  ///< No number of triangles, which can be missed.
  Rebake rebake_ = Rebake::on;
  ShrinkOptions shrink_options_;
  SaliencySource saliency_ = SaliencySource::none;
  SaliencyOptions saliency_options_;
  SalientOptions salient_options_;
  SimplifyOptions options_;
  ReadOptions read_options_;
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_simplify() { return std::make_unique<Simplify>(); }

}  // namespace fovea::cli
