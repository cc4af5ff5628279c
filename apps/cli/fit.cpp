#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "fit_curve.h"
#include "fovea/base/text.h"
#include "fovea/budget/fit.h"
#include "fovea/io/extension.h"
#include "fovea/io/write.h"
#include "input.h"
#include "report.h"
#include "shared_options.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

void check_curve_output(const std::filesystem::path& path, bool force) {
  check_extension(path, "curves", {".json", ".html"});
  check_place(path, force);
}

class Fit : public Verb {
 public:
  VerbText text() const override {
    return {
        "fit",
        "make a model fit into a number of bytes and look as good as it can",
        "Finds how many triangles and how many texels to give away so that the whole file takes no more than "
        "so many bytes and pictures of it lose least, seen as large as --view-size says. Or the smallest "
        "file that still looks as much like the original as asked. It measures both on the model itself: "
        "the same bytes are worth more in triangles here and in texels there.",
        {{"fovea fit helmet.glb -o helmet-500k.glb --bytes 500KB", "The best of at most 500,000 bytes."},
         {"fovea fit helmet.glb -o icon.glb --bytes 60KB --view-size 128",
          "For small pictures: other triangles and texels are worth it."},
         {"fovea fit chair.glb -o chair-same.glb --match ms-ssim=0.98@512",
          "The smallest that still looks the same at 512 pixels."},
         {"fovea fit helmet.glb -o h.glb --bytes 1MB --texture-format webp --curve curve.json",
          "With WebP; and what any number of bytes would give."},
         {"fovea fit city.glb -o city-lean.glb --bytes 2MB --views cameras",
          "Only what the model's own cameras see counts, along their paths if they are animated."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add(
        "Budget",
        {describe_bytes("Bytes of the whole file at most, such as 500KB.", bytes_),
         {"match",
          "Instead: the smallest file that is as like the original as this, psnr, ms-ssim or flip, in "
          "pictures of so many pixels (--view-size if left out).",
          &match_, "metric=value[@pixels]"}});
    arguments.add("Budget", describe(options_));
    arguments.add("Views", describe(options_.views));
    arguments.add("Budget", {{"allow-miss", "Exit with 0 even if no file is that small or that like.",
                              &allow_miss_, ""}});
    arguments.add(
        "Output",
        {describe_output(output_),
         {"curve",
          "A file for what any number of bytes would give: .json, or .html with the curve drawn and "
          "pictures along it.",
          &curve_, "file"}});
    arguments.add("Output", describe(options_.form.write));
    arguments.add("Limits", describe(read_options_));
    need_format(arguments, options_.form.write);
    need_views(arguments, options_.views);
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    const Snapshot before = snapshot(input.model, input.bytes);
    session.report["inputs"] = inputs_json({&input, 1});
    session.report["before"] = to_json(before);
    need_triangles(input);
    std::optional<BudgetFit> fit;
    session.phase("ladders", input.path, [&] { fit.emplace(input.model, options_, session.context); });
    const FitResult result = session.phase(
        "fit", input.path, [&] { return budget_ ? fit->within(*budget_) : fit->like(metric_, likeness_); });
    if (result.cancelled) return write_cancelled(result, session);
    if (!result.reached && !allow_miss_) return miss(result, session);
    FitCurve curve;
    if (!curve_.empty()) curve = session.phase("curve", [&] { return make_curve(*fit, result); });
    std::vector<CurvePicture> pictures;
    if (lower_extension(curve_) == ".html")
      pictures = session.phase("curve", [&] { return curve_pictures(*fit, curve.way, session.context); });
    const auto files = session.phase(
        "write", [&] { return write_model(result.model, output_, options_.form.write, session.context); });
    const Snapshot after = snapshot(result.model, measure_output(files, result.model));
    write_curve(curve, pictures);
    tell(session, before, after, result);
    return 0;
  }

 private:
  void check_request() {
    check_input(input_);
    check_output(output_, "small.glb", {input_}, options_.form.write.force, [&](const auto& path) {
      check_extension(path, "fitted models", {".glb", ".gltf"});
      fovea::check_output(path, options_.form.write);
    });
    if (!curve_.empty()) {
      check_output(curve_, "curve.json", {input_}, options_.form.write.force,
                   [&](const auto& path) { check_curve_output(path, options_.form.write.force); });
    }
    options_.form = file_form(output_, options_.form.write);
    if (bytes_.empty() == match_.empty()) {
      throw Error(ErrorKind::usage, bytes_.empty() ? "no budget is given" : "there are two targets", {},
                  "give --bytes, for example --bytes 500KB, or --match, for example --match ms-ssim=0.98");
    }
    if (!bytes_.empty()) budget_ = parse_bytes("--bytes", bytes_);
    if (budget_ && curve_.empty()) options_.most_bytes = *budget_;
    if (!match_.empty()) parse_match();
  }

  void parse_match() {
    const auto refuse = [&] {
      throw Error(ErrorKind::usage, fmt::format("'{}' is no likeness", printable(match_)), "--match",
                  "write psnr=DECIBELS, ms-ssim=0…1 or flip=0…1, and @PIXELS if they are not --view-size");
    };
    const std::size_t equals = match_.find('='), at = match_.find('@');
    if (equals == std::string::npos) refuse();
    constexpr std::array<std::pair<const char*, FitMetric>, 3> kMetrics{
        {{"psnr", FitMetric::psnr}, {"ms-ssim", FitMetric::ms_ssim}, {"flip", FitMetric::flip}}};
    const auto metric = std::ranges::find(kMetrics, match_.substr(0, equals),
                                          [](const auto& m) { return std::string(m.first); });
    if (metric == kMetrics.end()) refuse();
    metric_ = metric->second;
    likeness_ = parse_numbers("match", match_.substr(equals + 1, at - equals - 1), 1, 1)[0];
    const double most = metric_ == FitMetric::psnr ? 200 : 1;
    if (!(likeness_ >= 0 && likeness_ <= most)) refuse();
    if (at == std::string::npos) return;
    const double pixels = parse_numbers("match", match_.substr(at + 1), 1, 1)[0];
    if (!(pixels >= 64 && pixels <= 4096 && pixels == std::floor(pixels))) refuse();
    options_.view_size = static_cast<std::int64_t>(pixels);
  }

  /// Says what there is instead; nothing is written.
  int miss(const FitResult& result, Session& session) const {
    session.report["result"] = result_json(result);
    const std::string hint = "--compression meshopt and --texture-format webp take less";
    if (budget_) return too_many_bytes(session, *budget_, result.chosen.bytes, hint);
    session.say("error: stored as asked, not even the original is that like itself; nothing is written");
    return target_code(session, false, false);
  }

  static Json result_json(const FitResult& result) {
    Json json = to_json(result.chosen);
    json["reached"] = result.reached;
    json["pictures_of"] = result.pictures;
    json["path"] = Json::array();
    for (const FitPoint& point : result.path) json["path"].push_back(to_json(point));
    return json;
  }

  /// The best that was known is there, all the same.
  int write_cancelled(const FitResult& result, Session& session) const {
    Context context;
    write_model(result.model, output_, options_.form.write, context);
    session.report["result"] = result_json(result);
    session.say(fmt::format("cancelled: the best so far is written, {} triangles in {}",
                            count_text(result.chosen.triangles), bytes_text(result.chosen.bytes)));
    constexpr int kCancelled = 130;
    return kCancelled;
  }

  FitCurve make_curve(BudgetFit& fit, const FitResult& result) const {
    return {std::filesystem::path(input_).filename().string(), options_.view_size, result.chosen, fit.way(),
            fit.all()};
  }

  void write_curve(const FitCurve& curve, const std::vector<CurvePicture>& pictures) const {
    if (curve_.empty()) return;
    if (lower_extension(curve_) == ".html")
      return write_text(curve_, curve_page(curve, pictures), options_.form.write.force);
    Json json = to_json(curve.chosen);
    json["view_size"] = curve.view_size;
    for (const auto& [name, points] : {std::pair{"path", &curve.way}, {"all", &curve.all}}) {
      if (points == &curve.all && points->empty()) continue;
      json[name] = Json::array();
      for (const FitPoint& point : *points) json[name].push_back(to_json(point));
    }
    write_text(curve_, dump(json) + "\n", options_.form.write.force);
  }

  void tell(Session& session, const Snapshot& before, const Snapshot& after, const FitResult& result) const {
    session.report["outputs"] = Json::array({file_json(output_, after.bytes)});
    if (!curve_.empty()) session.report["outputs"].push_back(file_json(curve_));
    session.report["after"] = to_json(after);
    session.report["result"] = result_json(result);
    const FitPoint& chosen = result.chosen;
    const std::string likeness = std::isfinite(chosen.psnr_db)
                                     ? fmt::format("{:.2f} dB from the original", chosen.psnr_db)
                                     : std::string("as the original");
    session.print_summary(
        fmt::format("{} -> {}\n{}likeness {} at {} pixels, base colour and lit; {} models were drawn to find "
                    "it\ntime     {}\n",
                    printable(input_), printable(output_), comparison_text(before, after), likeness,
                    options_.view_size, result.pictures, session.spent_text()));
  }

  static FitOptions first_options() {
    FitOptions options;
    options.form.write.quantize = true;
    return options;
  }

  std::string input_, output_, curve_, bytes_, match_;
  std::optional<std::uint64_t> budget_;
  FitMetric metric_ = FitMetric::psnr;  ///< Of `match_`.
  double likeness_ = 0;
  bool allow_miss_ = false;
  FitOptions options_ = first_options();
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_fit() { return std::make_unique<Fit>(); }

}  // namespace fovea::cli
