#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

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

/// "500KB", "1.5 MB", "2MiB", "300000". Throws Error(usage) with the option.
std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr std::array<std::pair<const char*, double>, 8> kUnits{{{"", 1},
                                                                  {"b", 1},
                                                                  {"kb", 1e3},
                                                                  {"mb", 1e6},
                                                                  {"gb", 1e9},
                                                                  {"kib", 1024.0},
                                                                  {"mib", 1024.0 * 1024},
                                                                  {"gib", 1024.0 * 1024 * 1024}}};
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string unit(static_cast<const char*>(end), text.data() + text.size());
  std::erase(unit, ' ');
  const auto at =
      std::ranges::find(kUnits, lower_case(unit), [](const auto& u) { return std::string(u.first); });
  const double bytes = at == kUnits.end() ? 0 : number * at->second;
  if (error != std::errc() || !(bytes >= 1 && bytes < 1e15)) {
    throw Error(ErrorKind::usage, fmt::format("'{}' is no number of bytes", printable(text)), option,
                "write for example 500KB, 1.5MB or 300000");
  }
  return static_cast<std::uint64_t>(bytes);
}

void check_json_output(const std::filesystem::path& path, bool force) {
  check_extension(path, "curves", {".json"});
  check_place(path, force);
}

Json to_json(const FitPoint& point) {
  return {{"triangles", point.triangles},
          {"image_bytes", point.image_bytes},
          {"bytes", point.bytes},
          {"psnr", number_json(point.psnr_db)}};
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
          "With WebP; and what any number of bytes would give."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add(
        "Budget",
        {{"bytes", "Bytes of the whole file at most, such as 500KB.", &bytes_, "size"},
         {"match",
          "Instead: the smallest file that is as like the original as this, psnr, ms-ssim or flip, in "
          "pictures of so many pixels (--view-size if left out).",
          &match_, "metric=value[@pixels]"}});
    arguments.add("Budget", describe(options_));
    arguments.add("Budget", {{"allow-miss", "Exit with 0 even if no file is that small or that like.",
                              &allow_miss_, ""}});
    arguments.add("Output",
                  {describe_output(output_),
                   {"curve", "A .json file for the choices on the way: bytes, triangles, texels, likeness.",
                    &curve_, "file"}});
    arguments.add("Output", describe(options_.write));
    arguments.add("Limits", describe(read_options_));
    need_format(arguments, options_.write);
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    const Snapshot before = snapshot(input.model, input.bytes);
    session.report["inputs"] = inputs_json({&input, 1});
    session.report["before"] = to_json(before);
    need_triangles(input);
    FitResult result =
        session.phase("fit", input.path, [&] { return fit(input.model, options_, session.context); });
    if (!result.reached && !allow_miss_) return miss(result, session);
    const auto files = session.phase(
        "write", [&] { return write_model(result.model, output_, options_.write, session.context); });
    const Snapshot after = snapshot(result.model, measure_output(files, result.model));
    write_curve(result);
    tell(session, before, after, result);
    return 0;
  }

 private:
  void check_request() {
    check_input(input_);
    check_output(output_, "small.glb", {input_}, options_.write.force, [&](const auto& path) {
      check_extension(path, "fitted models", {".glb", ".gltf"});
      fovea::check_output(path, options_.write);
    });
    if (!curve_.empty()) {
      check_output(curve_, "curve.json", {input_}, options_.write.force,
                   [&](const auto& path) { check_json_output(path, options_.write.force); });
    }
    options_.binary = lower_extension(output_) == ".glb";
    options_.whole_path = !curve_.empty();
    options_.stem = std::filesystem::path(output_).stem().string();
    if (bytes_.empty() == match_.empty()) {
      throw Error(ErrorKind::usage, bytes_.empty() ? "no budget is given" : "there are two targets", {},
                  "give --bytes, for example --bytes 500KB, or --match, for example --match ms-ssim=0.98");
    }
    if (!bytes_.empty()) options_.bytes = parse_bytes("--bytes", bytes_);
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
    options_.match = metric->second;
    options_.match_value = parse_numbers("match", match_.substr(equals + 1, at - equals - 1), 1, 1)[0];
    const double most = options_.match == FitMetric::psnr ? 200 : 1;
    if (!(options_.match_value >= 0 && options_.match_value <= most)) refuse();
    if (at == std::string::npos) return;
    const double pixels = parse_numbers("match", match_.substr(at + 1), 1, 1)[0];
    if (!(pixels >= 64 && pixels <= 4096 && pixels == std::floor(pixels))) refuse();
    options_.view_size = static_cast<std::int64_t>(pixels);
  }

  /// Says what there is instead; nothing is written.
  int miss(const FitResult& result, Session& session) const {
    const FitPoint& last = result.chosen;
    session.report["result"] = result_json(result);
    if (options_.bytes) {
      session.say(fmt::format("error: no file takes {} or less: the smallest has {}, with {} triangles",
                              bytes_text(*options_.bytes), bytes_text(last.bytes),
                              count_text(last.triangles)));
    } else {
      session.say("error: stored as asked, not even the original is that like itself");
    }
    session.say(
        "hint: --allow-miss writes it all the same; --compression meshopt and --texture-format webp take "
        "less");
    constexpr int kMissed = 8;
    return kMissed;
  }

  static Json result_json(const FitResult& result) {
    Json json = to_json(result.chosen);
    json["reached"] = result.reached;
    json["pictures_of"] = result.pictures;
    json["path"] = Json::array();
    for (const FitPoint& point : result.path) json["path"].push_back(to_json(point));
    return json;
  }

  void write_curve(const FitResult& result) const {
    if (curve_.empty()) return;
    const std::string text = dump(result_json(result)) + "\n";
    const std::span<const std::byte> bytes = std::as_bytes(std::span(text));
    const OutputFile file{"", {bytes.begin(), bytes.end()}};
    write_files(curve_, {&file, 1}, options_.write.force);
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
    options.write.quantize = true;
    return options;
  }

  std::string input_, output_, curve_, bytes_, match_;
  bool allow_miss_ = false;
  FitOptions options_ = first_options();
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_fit() { return std::make_unique<Fit>(); }

}  // namespace fovea::cli
