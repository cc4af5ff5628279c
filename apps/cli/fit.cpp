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
         {"fovea fit helmet.glb -o web.glb --bytes 1MB,300KB,80KB",
          "Three files, web-1MB.glb, web-300KB.glb and web-80KB.glb."},
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
        {{"bytes",
          "Bytes of the whole file at most, such as 500KB. Of several, falling, such as 1MB,300KB,80KB, each "
          "gets a file, small-300KB.glb for -o small.glb: that takes less time than one by one.",
          &bytes_, "sizes"},
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
    const std::vector<FitResult> results = session.phase("fit", input.path, [&] { return find(*fit); });
    const FitResult& last = results.back();
    if (last.cancelled) return write_cancelled(results, session);
    if (!last.reached && !allow_miss_) return miss(results, session);
    FitCurve curve;
    if (!curve_.empty()) curve = session.phase("curve", [&] { return make_curve(*fit, results); });
    std::vector<CurvePicture> pictures;
    if (lower_extension(curve_) == ".html")
      pictures = session.phase("curve", [&] { return curve_pictures(*fit, curve.way, session.context); });
    const std::vector<Snapshot> after =
        session.phase("write", [&] { return write(results, session.context); });
    write_curve(curve, pictures);
    tell(session, before, after, results);
    return 0;
  }

 private:
  void check_request() {
    check_input(input_);
    check_output(output_, "small.glb", {input_}, options_.form.write.force, [&](const auto& path) {
      check_extension(path, "fitted models", {".glb", ".gltf"});
    });
    if (bytes_.empty() == match_.empty()) {
      throw Error(ErrorKind::usage, bytes_.empty() ? "no budget is given" : "there are two targets", {},
                  "give --bytes, for example --bytes 500KB, or --match, for example --match ms-ssim=0.98");
    }
    outputs_ = {output_};
    if (!bytes_.empty()) budgets_ = parse_byte_list("--bytes", bytes_);
    if (budgets_.size() > 1) outputs_ = outputs_of_budgets();
    for (const std::string& path : outputs_) {
      check_output(path, "small.glb", {input_}, options_.form.write.force,
                   [&](const auto& place) { fovea::check_output(place, options_.form.write); });
    }
    if (!curve_.empty()) {
      check_output(curve_, "curve.json", {input_}, options_.form.write.force,
                   [&](const auto& path) { check_curve_output(path, options_.form.write.force); });
    }
    // Of a .gltf the longest name takes most bytes.
    const auto longest = std::ranges::max_element(outputs_, {}, &std::string::size);
    options_.form = file_form(*longest, options_.form.write);
    if (!budgets_.empty() && curve_.empty()) options_.most_bytes = budgets_.front();
    if (!match_.empty()) parse_match();
  }

  /// small.glb for 600KB and 150KB: small-600KB.glb, small-150KB.glb.
  std::vector<std::string> outputs_of_budgets() const {
    std::vector<std::string> outputs;
    for (std::string budget : split_list(bytes_)) {
      std::erase(budget, ' ');
      std::filesystem::path path = output_;
      path.replace_filename(path.stem().string() + "-" + budget + path.extension().string());
      outputs.push_back(path.string());
    }
    return outputs;
  }

  /// For each budget, or up to one that is not reached or at which it was cancelled.
  std::vector<FitResult> find(BudgetFit& fit) const {
    std::vector<FitResult> results;
    if (budgets_.empty()) results.push_back(fit.like(metric_, likeness_));
    for (const std::uint64_t budget : budgets_) {
      try {
        results.push_back(fit.within(budget));
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::cancelled || results.empty()) throw;
        results.back().cancelled = true;
      }
      if (results.back().cancelled || (!results.back().reached && !allow_miss_)) break;
    }
    return results;
  }

  std::vector<Snapshot> write(const std::vector<FitResult>& results, Context& context) const {
    std::vector<Snapshot> written;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const Model& model = results[i].model;
      written.push_back(snapshot(
          model, measure_output(write_model(model, outputs_[i], options_.form.write, context), model)));
    }
    return written;
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
  int miss(const std::vector<FitResult>& results, Session& session) const {
    const FitResult& result = results.back();
    session.report["result"] = result_json(result);
    const std::string hint = "--compression meshopt and --texture-format webp take less";
    if (!budgets_.empty())
      return too_many_bytes(session, budgets_[results.size() - 1], result.chosen.bytes, hint);
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

  /// The results, as one or as a list, and their files.
  void report(Session& session, const std::vector<FitResult>& results,
              const std::vector<Snapshot>& after) const {
    session.report["outputs"] = Json::array();
    for (std::size_t i = 0; i < results.size(); ++i) {
      session.report["outputs"].push_back(file_json(outputs_[i], after[i].bytes));
      Json result = result_json(results[i]);
      result["bytes"] = after[i].bytes.files;
      if (outputs_.size() == 1) {
        session.report["after"] = to_json(after[i]);
        session.report["result"] = std::move(result);
      } else {
        result["budget"] = budgets_[i];
        result["after"] = to_json(after[i]);
        session.report["results"].push_back(std::move(result));
      }
    }
  }

  /// The best that was known is there, all the same.
  int write_cancelled(const std::vector<FitResult>& results, Session& session) const {
    Context context;
    const std::vector<Snapshot> after = write(results, context);
    report(session, results, after);
    const FitPoint& chosen = results.back().chosen;
    session.say(fmt::format(
        "cancelled: the best so far is written, {} triangles in {}{}", count_text(chosen.triangles),
        bytes_text(chosen.bytes),
        outputs_.size() > 1 ? fmt::format("; {} of {} files", results.size(), outputs_.size()) : ""));
    constexpr int kCancelled = 130;
    return kCancelled;
  }

  FitCurve make_curve(BudgetFit& fit, const std::vector<FitResult>& results) const {
    std::vector<FitPoint> chosen;
    for (const FitResult& result : results) chosen.push_back(result.chosen);
    return {std::filesystem::path(input_).filename().string(), options_.view_size, std::move(chosen),
            fit.way(), fit.all()};
  }

  void write_curve(const FitCurve& curve, const std::vector<CurvePicture>& pictures) const {
    if (curve_.empty()) return;
    if (lower_extension(curve_) == ".html")
      return write_text(curve_, curve_page(curve, pictures), options_.form.write.force);
    Json json;
    json["view_size"] = curve.view_size;
    for (const auto& [name, points] :
         {std::pair{"chosen", &curve.chosen}, {"path", &curve.way}, {"all", &curve.all}}) {
      if (points == &curve.all && points->empty()) continue;
      json[name] = Json::array();
      for (const FitPoint& point : *points) json[name].push_back(to_json(point));
    }
    write_text(curve_, dump(json) + "\n", options_.form.write.force);
  }

  void tell(Session& session, const Snapshot& before, const std::vector<Snapshot>& after,
            const std::vector<FitResult>& results) const {
    report(session, results, after);
    if (!curve_.empty()) session.report["outputs"].push_back(file_json(curve_));
    const std::string seen =
        fmt::format("at {} pixels, base colour and lit; {} models were drawn to find {}\n",
                    options_.view_size, results.back().pictures, results.size() > 1 ? "them" : "it");
    const auto likeness = [](const FitPoint& point) {
      return std::isfinite(point.psnr_db) ? fmt::format("{:.2f} dB from the original", point.psnr_db)
                                          : std::string("as the original");
    };
    std::string text;
    if (results.size() == 1) {
      text = fmt::format("{} -> {}\n{}likeness {} {}", printable(input_), printable(outputs_[0]),
                         comparison_text(before, after[0]), likeness(results[0].chosen), seen);
    } else {
      TextTable table("lrrrl");
      table.row({"", "bytes", "triangles", "images", "likeness"});
      for (std::size_t i = 0; i < results.size(); ++i) {
        const FitPoint& chosen = results[i].chosen;
        table.row({printable(outputs_[i]), bytes_text(after[i].bytes.files), count_text(chosen.triangles),
                   bytes_text(chosen.image_bytes), likeness(chosen)});
      }
      text = fmt::format("{} -> {} files\n{}{}", printable(input_), results.size(), table.text(0), seen);
    }
    session.print_summary(fmt::format("{}time     {}\n", text, session.spent_text()));
  }

  static FitOptions first_options() {
    FitOptions options;
    options.form.write.quantize = true;
    return options;
  }

  std::string input_, output_, curve_, bytes_, match_;
  std::vector<std::string> outputs_;    ///< One for each budget, or for the likeness.
  std::vector<std::uint64_t> budgets_;  ///< Of `bytes_`, falling.
  FitMetric metric_ = FitMetric::psnr;  ///< Of `match_`.
  double likeness_ = 0;
  bool allow_miss_ = false;
  FitOptions options_ = first_options();
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_fit() { return std::make_unique<Fit>(); }

}  // namespace fovea::cli
