#include "fovea/judge/compare.h"

#include <fmt/format.h>

#include <cmath>

#include "fovea/io/extension.h"
#include "fovea/io/write.h"
#include "fovea/judge/report.h"
#include "input.h"
#include "report.h"
#include "shared_options.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

const char* name_of(JudgedPass pass) { return pass == JudgedPass::lit ? "lit" : "base_color"; }

Json as_json(const ImageScores& s) {
  return {{"psnr", number_json(s.psnr)},
          {"psnr_foreground", number_json(s.psnr_foreground)},
          {"ssim", s.ssim},
          {"ssim_foreground", s.ssim_foreground},
          {"ms_ssim", s.ms_ssim},
          {"ms_ssim_foreground", s.ms_ssim_foreground},
          {"flip", s.flip},
          {"flip_foreground", s.flip_foreground}};
}

Json as_json(const Deviation& d, double diagonal) {
  return {{"mean", number_json(d.mean)},
          {"rms", number_json(d.rms)},
          {"max", number_json(d.max)},
          {"mean_rel", number_json(d.mean / diagonal)},
          {"max_rel", number_json(d.max / diagonal)}};
}

Json as_json(const SurfaceDistance& d, double diagonal) {
  return {{"forward", as_json(d.forward, diagonal)},
          {"backward", as_json(d.backward, diagonal)},
          {"mean_rel", number_json(d.mean() / diagonal)},
          {"hausdorff_rel", number_json(d.hausdorff() / diagonal)}};
}

Json as_json(const Comparison& c) {
  Json views = Json::array();
  for (const ViewComparison& view : c.views) {
    Json json{{"name", view.name}};
    for (const JudgedPass pass : kJudgedPasses)
      json[name_of(pass)] = as_json(view.passes[static_cast<std::size_t>(pass)]);
    json["silhouette_iou"] = view.silhouette_iou;
    views.push_back(std::move(json));
  }
  Json json;
  for (const JudgedPass pass : kJudgedPasses) json[name_of(pass)] = as_json(c[pass]);
  json["silhouette_iou"] = c.silhouette_iou;
  json["distance"] = c.distance ? as_json(*c.distance, c.reference_diagonal) : Json();
  json["views"] = std::move(views);
  return json;
}

std::string decibels(double psnr) { return std::isfinite(psnr) ? fmt::format("{:.2f}", psnr) : "same"; }

/// A small share in the unit in which it has a digit before the point.
std::string share_text(double share) {
  return std::isfinite(share) ? fmt::format("{:.3f} %", 100 * share) : "infinite";
}

class Compare : public Verb {
 public:
  VerbText text() const override {
    return {
        "compare",
        "say how like models are to a reference",
        "Draws a reference and other models from the same sides and compares the pictures: PSNR, SSIM and "
        "MS-SSIM (1 is identical), FLIP (0 is identical), the silhouettes; and measures how far the surfaces "
        "are apart.",
        {{"fovea compare helmet.glb small.glb", "How good is small.glb?"},
         {"fovea compare helmet.glb a.glb b.glb c.glb --json", "Three candidates, every view, for programs."},
         {"fovea compare helmet.glb small.glb --report small.html",
          "A page to look at, with everything in it."},
         {"fovea compare fox.glb fox-10.glb --animation 0 --time 0.4", "At a moment of an animation."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add({"REFERENCE", "The model that the others should look like.", &reference_});
    arguments.add({"MODEL", "One or more models to compare with it.", nullptr, true, &tests_});
    arguments.add("Comparison", describe(options_));
    arguments.add("Output",
                  {{"report", "Write a page with pictures of every view, ending in .html.", &report_, "file"},
                   describe_force(force_)});
    arguments.add("Limits", describe(read_options_));
    need_views(arguments, options_.views);
    arguments.need({{"force"}, "--report", [&] { return !report_.empty(); }});
  }

  int run(Session& session) override {
    check(options_.pose);
    check_input(reference_);
    if (!report_.empty()) {
      check_output(report_, "page.html", inputs(), force_, [&](const auto& path) {
        check_extension(path, "pages", {".html"});
        check_place(path, force_);
      });
    }
    for (const std::string& test : tests_) check_input(test);
    session.report["inputs"] = Json::array();
    const Compared reference = read(session, reference_);
    std::vector<Compared> tests;
    std::vector<const Model*> models;
    for (const std::string& test : tests_) tests.push_back(read(session, test));
    for (const Compared& test : tests) models.push_back(&test.input.model);
    CompareReport report;
    const std::vector<Comparison> found = session.phase("compare", reference_, [&] {
      return compare(reference.input.model, models, options_, session.context,
                     report_.empty() ? CompareObserver{} : report.observer());
    });
    if (!report_.empty()) session.phase("report", [&] { write_report(report, reference, tests, found); });
    tell(session, reference, tests, found);
    return 0;
  }

 private:
  struct Compared {
    Input input;
    Snapshot size;
  };

  std::vector<std::string> inputs() const {
    std::vector<std::string> all = tests_;
    all.push_back(reference_);
    return all;
  }

  static ReportModel report_model(const Compared& c) {
    return {std::filesystem::path(c.input.path).filename().string(), c.size.counts.triangles,
            c.size.counts.split_vertices, c.size.bytes.kinds};
  }

  void write_report(const CompareReport& report, const Compared& reference,
                    const std::vector<Compared>& tests, const std::vector<Comparison>& found) const {
    std::vector<ReportModel> shown;
    for (const Compared& test : tests) shown.push_back(report_model(test));
    const std::string page = report.html(report_model(reference), shown, found);
    OutputFile file;
    const auto* bytes = reinterpret_cast<const std::byte*>(page.data());
    file.bytes.assign(bytes, bytes + page.size());
    write_files(report_, {&file, 1}, force_);
  }

  Compared read(Session& session, const std::string& path) const {
    Input input = read_input(session, path, read_options_);
    const Snapshot size = snapshot(input.model, input.bytes);
    Json json = file_json(path, input.bytes);
    json["triangles"] = size.counts.triangles;
    session.report["inputs"].push_back(std::move(json));
    need_triangles(input);
    about(path, [&] { pose_of(input.model, options_.pose); });  // which of the models lacks it
    return {std::move(input), size};
  }

  void tell(Session& session, const Compared& reference, const std::vector<Compared>& tests,
            const std::vector<Comparison>& found) const {
    if (!report_.empty()) session.report["outputs"] = Json::array({file_json(report_)});
    Json& results = session.report["results"] = Json::array();
    TextTable table("lrrrrrrrrrr");
    table.row({"", "triangles", "bytes", "FLIP lit", "base", "MS-SSIM lit", "base", "PSNR lit", "base",
               "outline", "surface"});
    const auto row = [&](const Compared& c, std::vector<std::string> scores) {
      scores.insert(scores.begin(), {printable(c.input.path), count_text(c.size.counts.triangles),
                                     bytes_text(c.size.bytes.files)});
      table.row(scores);
    };
    row(reference, {});
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Comparison& c = found[i];
      Json json{{"path", tests[i].input.path}};
      json.update(as_json(c));
      results.push_back(std::move(json));
      const ImageScores &lit = c[JudgedPass::lit], &base = c[JudgedPass::base_color];
      row(tests[i], {fmt::format("{:.4f}", lit.flip), fmt::format("{:.4f}", base.flip),
                     fmt::format("{:.4f}", lit.ms_ssim), fmt::format("{:.4f}", base.ms_ssim),
                     decibels(lit.psnr), decibels(base.psnr), fmt::format("{:.4f}", c.silhouette_iou),
                     c.distance ? share_text(c.distance->mean() / c.reference_diagonal) : "-"});
    }
    session.print(table.text(0));
    session.print(fmt::format(
        "{}; FLIP: 0 is identical; outline: shared part of the silhouettes; surface: mean distance, of the "
        "diagonal\n",
        plural(found.empty() ? 0 : found.front().views.size(), "view", "views")));
    session.print_summary(session.spent_text() + "\n");
  }

  std::string reference_;
  std::vector<std::string> tests_;
  std::string report_;
  bool force_ = false;
  CompareOptions options_;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_compare() { return std::make_unique<Compare>(); }

}  // namespace fovea::cli
