#include "fovea/judge/compare.h"

#include <fmt/format.h>

#include <cmath>

#include "fovea/io/file_bytes.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/judge/report.h"
#include "report.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

const char* name_of(JudgedPass pass) { return pass == JudgedPass::lit ? "lit" : "base_color"; }

Json to_json(const ImageScores& s) {
  return {{"psnr", number_json(s.psnr)},
          {"psnr_foreground", number_json(s.psnr_foreground)},
          {"ssim", s.ssim},
          {"ssim_foreground", s.ssim_foreground},
          {"ms_ssim", s.ms_ssim},
          {"ms_ssim_foreground", s.ms_ssim_foreground},
          {"flip", s.flip},
          {"flip_foreground", s.flip_foreground}};
}

Json to_json(const Deviation& d, double diagonal) {
  return {{"mean", number_json(d.mean)},
          {"rms", number_json(d.rms)},
          {"max", number_json(d.max)},
          {"mean_rel", number_json(d.mean / diagonal)},
          {"max_rel", number_json(d.max / diagonal)}};
}

Json to_json(const Comparison& c) {
  Json views = Json::array();
  for (const ViewComparison& view : c.views) {
    Json json{{"name", view.name}};
    for (const JudgedPass pass : kJudgedPasses)
      json[name_of(pass)] = to_json(view.passes[static_cast<std::size_t>(pass)]);
    json["silhouette_iou"] = view.silhouette_iou;
    views.push_back(std::move(json));
  }
  Json json;
  for (const JudgedPass pass : kJudgedPasses) json[name_of(pass)] = to_json(c[pass]);
  json["silhouette_iou"] = c.silhouette_iou;
  json["distance"] = {{"forward", to_json(c.distance.forward, c.reference_diagonal)},
                      {"backward", to_json(c.distance.backward, c.reference_diagonal)},
                      {"mean_rel", number_json(c.distance.mean() / c.reference_diagonal)},
                      {"hausdorff_rel", number_json(c.distance.hausdorff() / c.reference_diagonal)}};
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
    arguments.add("Comparison", {{"animation", "Pose all models by this animation, counted from 0.",
                                  &animation_, "", 0, 1e6},
                                 {"time", "Moment of the animation.", &time_s_, "seconds", 0, 1e9}});
    arguments.add("Output",
                  {{"report", "Write a page with pictures of every view, ending in .html.", &report_, "file"},
                   describe_force(force_)});
    arguments.add("Limits", describe(read_options_));
  }

  int run(Session& session) override {
    if (time_s_ && !animation_)
      throw Error(ErrorKind::usage, "--time needs --animation", {}, "for example --animation 0");
    check_input(reference_);
    if (!report_.empty()) check_output(report_, inputs(), force_, check_report_output);
    for (const std::string& test : tests_) check_input(test);
    const Model reference = read(session, reference_);
    std::vector<Model> models;
    std::vector<const Model*> tests;
    for (const std::string& test : tests_) models.push_back(read(session, test));
    for (const Model& model : models) tests.push_back(&model);
    CompareReport report(report_.empty() ? 0 : view_count(options_, reference), tests.size());
    const std::vector<Comparison> found = session.phase("compare", [&] {
      return compare(reference, tests, options_, session.context,
                     animation_ ? static_cast<int>(*animation_) : -1, time_s_.value_or(0),
                     report_.empty() ? CompareObserver{} : report.observer());
    });
    if (!report_.empty()) session.phase("report", [&] { write_report(report, reference, models, found); });
    tell(session, reference, models, found);
    return 0;
  }

 private:
  std::vector<std::string> inputs() const {
    std::vector<std::string> all = tests_;
    all.push_back(reference_);
    return all;
  }

  static void check_report_output(const std::filesystem::path& path, bool force) {
    if (path.extension() != ".html") {
      throw Error(ErrorKind::usage, "is not the name of a page", path.string(),
                  "use a name that ends in .html");
    }
    check_place(path, force);
  }

  static ReportModel report_model(const std::string& path, const Model& model) {
    const ModelCounts sizes = counts(model);
    return {std::filesystem::path(path).filename().string(), sizes.triangles, sizes.split_vertices,
            measure_input(path, model).kinds};
  }

  void write_report(const CompareReport& report, const Model& reference, const std::vector<Model>& models,
                    const std::vector<Comparison>& found) const {
    std::vector<ReportModel> shown;
    for (std::size_t i = 0; i < models.size(); ++i) shown.push_back(report_model(tests_[i], models[i]));
    const std::string page = report.html(report_model(reference_, reference), shown, found);
    OutputFile file;
    const auto* bytes = reinterpret_cast<const std::byte*>(page.data());
    file.bytes.assign(bytes, bytes + page.size());
    write_files(report_, {&file, 1}, force_);
  }

  Model read(Session& session, const std::string& path) const {
    return session.phase("read", [&] { return read_model(path, read_options_, session.context); });
  }

  void tell(Session& session, const Model& reference, const std::vector<Model>& models,
            const std::vector<Comparison>& found) const {
    const auto describe_file = [](const std::string& path, const Model& model) {
      return Json{{"path", path},
                  {"bytes", measure_input(path, model).files},
                  {"triangles", counts(model).triangles}};
    };
    session.report["reference"] = describe_file(reference_, reference);
    if (!report_.empty()) session.report["outputs"] = Json::array({{{"path", report_}}});
    Json& results = session.report["results"] = Json::array();
    TextTable table("lrrrrrrrrrr");
    table.row({"", "triangles", "bytes", "FLIP lit", "base", "MS-SSIM lit", "base", "PSNR lit", "base",
               "outline", "surface"});
    const auto sizes = [&](const std::string& path, const Model& model) {
      return std::pair{count_text(counts(model).triangles), bytes_text(measure_input(path, model).files)};
    };
    const auto [triangles, bytes] = sizes(reference_, reference);
    table.row({printable(reference_), triangles, bytes});
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Comparison& c = found[i];
      Json json = describe_file(tests_[i], models[i]);
      json.update(to_json(c));
      results.push_back(std::move(json));
      const ImageScores &lit = c[JudgedPass::lit], &base = c[JudgedPass::base_color];
      const auto [count, size] = sizes(tests_[i], models[i]);
      table.row({printable(tests_[i]), count, size, fmt::format("{:.4f}", lit.flip),
                 fmt::format("{:.4f}", base.flip), fmt::format("{:.4f}", lit.ms_ssim),
                 fmt::format("{:.4f}", base.ms_ssim), decibels(lit.psnr), decibels(base.psnr),
                 fmt::format("{:.4f}", c.silhouette_iou),
                 share_text(c.distance.mean() / c.reference_diagonal)});
    }
    session.print(table.text(0));
    session.print(fmt::format(
        "{}; FLIP: 0 is identical; outline: shared part of the silhouettes; surface: mean distance, of the "
        "diagonal\n",
        plural(found.empty() ? 0 : found.front().views.size(), "view", "views")));
  }

  std::string reference_;
  std::vector<std::string> tests_;
  std::string report_;
  bool force_ = false;
  std::optional<std::int64_t> animation_;
  std::optional<double> time_s_;
  CompareOptions options_;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_compare() { return std::make_unique<Compare>(); }

}  // namespace fovea::cli
