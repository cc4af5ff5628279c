#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "flight.h"
#include "fovea/base/text.h"
#include "fovea/cluster/cluster_properties.h"
#include "fovea/cluster/clusters.h"
#include "fovea/gpu/gpu_context.h"
#include "fovea/io/extension.h"
#include "fovea/io/image_file.h"
#include "fovea/io/write.h"
#include "fovea/lod/cluster_importance.h"
#include "fovea/lod/cluster_selection.h"
#include "fovea/lod/error_selection.h"
#include "fovea/lod/multi_tessellation.h"
#include "fovea/lod/uniform_selection.h"
#include "fovea/model/image_error.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/salient.h"
#include "fovea/surface/scene_surface.h"
#include "input.h"
#include "report.h"
#include "shared_options.h"
#include "sheet.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

enum class SelectionRule { error, clusters, uniform };
enum class Device { automatic, cpu, gpu };

constexpr double kCoarsest =
    0.002;  // of the triangles: levels go down to that, if no smaller ratio is asked for
constexpr std::size_t kStripFrames = 8;

void check_csv_output(const std::filesystem::path& path, bool force) {
  check_extension(path, "frame times", {".csv"});
  check_place(path, force);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::string cell(const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : ""; }

std::string csv(const std::vector<FrameReport>& frames) {
  std::string text =
      "ratio,frame,triangles,cracks,full_draw_ms,cpu_update_ms,cpu_draw_ms,gpu_update_ms,gpu_draw_ms,psnr,"
      "ms_ssim,flip\n";
  for (const FrameReport& f : frames) {
    const auto score = [&](double ImageScores::*member) {
      return f.scores ? cell((*f.scores).*member) : std::string();
    };
    text += fmt::format("{},{},{},{},{},{:.6g},{},{},{},{},{},{}\n", f.ratio, f.frame, f.triangles, f.cracks,
                        cell(f.full_draw_ms), f.cpu_update_ms, cell(f.cpu_draw_ms), cell(f.gpu_update_ms),
                        cell(f.gpu_draw_ms), score(&ImageScores::psnr), score(&ImageScores::ms_ssim),
                        score(&ImageScores::flip));
  }
  return text;
}

class Fly : public Verb {
 public:
  VerbText text() const override {
    return {"fly",
            "measure levels that follow the eye along a camera's way",
            "Flies a camera around a model and makes the level for each frame: the triangles that the view "
            "needs most, at so many shares of the original. Says what a frame takes with all triangles, with "
            "levels made on the processor and with levels made on the graphics card by OpenGL 4.3, and how "
            "like the original it looks; without such a card, what the processor does.",
            {{"fovea fly dragon.ply", "Times and likeness at 5, 35 and 60 % of the triangles."},
             {"fovea fly dragon.ply -o flight.csv --strip flight.png --frames 120",
              "Each frame's numbers, and pictures along the way."},
             {"fovea fly dragon.ply --select clusters --clusters 45",
              "By salient clusters, as Munaretti 2007 did."},
             {"fovea fly dragon.ply --ratios 0.02 --spread 10",
              "2 % of the triangles; a new level every ten frames."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add("Flight", describe(flight_));
    arguments.add("Flight", {{"ratios", "Shares of the triangles to fly with.", &ratios_, "ratio,..."}});
    arguments.add(
        "Levels",
        {{"select",
          "What levels leave out: what errors look smallest on the screen; what clusters look least "
          "important; or the same everywhere, to compare with.",
          choice(rule_, {"error", "clusters", "uniform"}), ""},
         {"salient", "Weigh errors by where people look; clusters always do.", &salient_, ""},
         {"unseen", "What errors out of sight count for.", &selection_.unseen, "", 0, 1}});
    arguments.add("Clusters", describe(clusters_));
    arguments.add("Clusters", describe(matching_));
    arguments.add("Saliency", describe(saliency_options_));
    arguments.add("Device", {{"device",
                              "Whether levels are drawn and made on the graphics card too; by itself where "
                              "there is OpenGL 4.3.",
                              choice(device_, {"auto", "cpu", "gpu"}), ""}});
    arguments.add("Output", {{"output", "A .csv file for the numbers of each frame.", &output_, "output"},
                             {"strip",
                              "A picture of frames along the way: the original above, a row for "
                              "each ratio below.",
                              &strip_, "file"},
                             describe_force(force_)});
    arguments.add("Limits", describe(read_options_));
    declare_needs(arguments);
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    session.report["inputs"] = inputs_json({&input, 1});
    need_triangles(input);
    std::optional<GpuContext> gpu;
    if (device_ != Device::cpu) open_card(gpu, session);
    const Prepared prepared = prepare(input, session);
    const std::unique_ptr<LevelSelection> selection =
        session.phase("selection", [&] { return make_selection(input.model, prepared); });
    const FlightReport report = session.phase("fly", input.path, [&] {
      return fly(input.model, prepared.hierarchy, *selection, parsed_ratios_, flight_, gpu.has_value(),
                 session);
    });
    session.phase("write", [&] { write(report, session); });
    tell(report, gpu, session);
    return 0;
  }

 private:
  /// What selections are made from.
  struct Prepared {
    SceneSurface scene;
    Clusters clusters;
    std::vector<ClusterProperties> properties;
    Importance importance;  ///< Of the simplification, and of errors on the screen.
    MultiTessellation levels;
    VertexHierarchy hierarchy;
  };

  void declare_needs(Arguments& arguments) const {
    const auto uses_clusters = [this] { return rule_ == SelectionRule::clusters; };
    arguments.need({{"clusters", "method", "rounds", "matching"}, "--select clusters", uses_clusters});
    arguments.need({{"unseen"}, "--select error", [this] { return rule_ == SelectionRule::error; }});
    std::vector<std::string> names;
    SaliencyOptions saliency;
    for (const Option& option : describe(saliency)) names.push_back(option.name);
    arguments.need({names, "--salient or --select clusters",
                    [this, uses_clusters] { return salient_ || uses_clusters(); }});
    arguments.need({{"strip"},
                    "frames that are compared",
                    [this] { return flight_.judge_every > 0; },
                    "leave out --judge-every 0"});
  }

  void check_request() {
    check_input(input_);
    if (!output_.empty()) {
      check_output(output_, "flight.csv", {input_}, force_,
                   [&](const auto& path) { check_csv_output(path, force_); });
    }
    if (!strip_.empty()) {
      check_output(strip_, "flight.png", {input_}, force_,
                   [&](const auto& path) { check_image_output(path, force_); });
    }
    parsed_ratios_ = parse_numbers("ratios", ratios_, 1, 16);
    for (const double ratio : parsed_ratios_) {
      if (!(ratio > 0 && ratio <= 1)) {
        throw Error(ErrorKind::usage, fmt::format("{} is no share of the triangles", ratio), "--ratios",
                    "shares are above 0 and at most 1, for example --ratios 0.05,0.35,0.6");
      }
    }
  }

  void open_card(std::optional<GpuContext>& gpu, Session& session) const {
    try {
      gpu.emplace();
    } catch (const Error& error) {
      if (device_ == Device::gpu) throw;
      session.context.report("no-gpu", error.what());
    }
  }

  Prepared prepare(const Input& input, Session& session) const {
    const Model& model = input.model;
    Prepared prepared;
    prepared.scene = scene_surface(model, rest_pose(model));
    if (salient_ || rule_ == SelectionRule::clusters) {
      const ModelSaliency found = session.phase(
          "saliency", input.path, [&] { return model_saliency(model, saliency_options_, session.context); });
      const VertexField saliency = joined(found.saliency);
      if (rule_ == SelectionRule::clusters) {
        session.phase("clusters", input.path, [&] {
          prepared.clusters = make_clusters(prepared.scene, saliency, clusters_, session.context);
          prepared.properties = cluster_properties(prepared.scene, saliency, prepared.clusters);
          prepared.importance =
              cluster_importance(model, prepared.scene, saliency, prepared.clusters, session.context);
        });
      } else {
        prepared.importance = salient_importance(model, found.saliency, {}, session.context);
      }
    }
    if (input.levels) {
      prepared.levels = *input.levels;
    } else {
      CollapseRecord record = session.phase(
          "simplify", input.path, [&] { return coarsest(model, prepared.importance, session.context); });
      prepared.levels = session.phase("levels", input.path, [&] {
        return make_multi_tessellation(model, std::move(record), session.context);
      });
    }
    prepared.hierarchy = session.phase(
        "hierarchy", [&] { return make_vertex_hierarchy(model, prepared.levels, session.context); });
    return prepared;
  }

  CollapseRecord coarsest(const Model& model, const Importance& importance, Context& context) const {
    SimplifyOptions options;
    options.metric = Metric::quadric;
    options.ratio = std::min(kCoarsest, *std::min_element(parsed_ratios_.begin(), parsed_ratios_.end()));
    return simplify(model, options, importance, context).record;
  }

  std::unique_ptr<LevelSelection> make_selection(const Model& model, const Prepared& prepared) const {
    switch (rule_) {
      case SelectionRule::clusters:
        return std::make_unique<ClusterSelection>(prepared.scene, prepared.levels, prepared.clusters,
                                                  prepared.properties, matching_);
      case SelectionRule::uniform: return std::make_unique<UniformSelection>(prepared.levels);
      default:
        return std::make_unique<ErrorSelection>(model, prepared.levels, prepared.importance, selection_);
    }
  }

  void write(const FlightReport& report, Session& session) const {
    session.report["outputs"] = Json::array();
    if (!output_.empty()) {
      write_text(output_, csv(report.frames), force_);
      session.report["outputs"].push_back(file_json(output_));
    }
    if (strip_.empty()) return;
    std::vector<Image8> pictures;
    const std::size_t count = report.strip.front().size(), shown = std::min(count, kStripFrames);
    for (const std::vector<Image8>& row : report.strip) {
      for (std::size_t i = 0; i < shown; ++i) pictures.push_back(row[i * count / shown]);
    }
    write_image(join_sheet(pictures, static_cast<std::int64_t>(shown)), strip_, force_);
    session.report["outputs"].push_back(file_json(strip_));
  }

  void tell(const FlightReport& report, const std::optional<GpuContext>& gpu, Session& session) const {
    session.report["device"] = gpu ? Json(gpu->device()) : Json();
    session.report["ratios"] = Json::array();
    TextTable table("rrrrrrrrr");
    table.row({"ratio", "triangles", "full ms", "CPU ms", "GPU ms", "full/GPU", "CPU/GPU", "PSNR", "FLIP"});
    for (const double ratio : parsed_ratios_) {
      const Json row = ratio_json(report, ratio);
      session.report["ratios"].push_back(row);
      const auto number = [&](const char* key) {
        return row[key].is_null() ? std::string("-") : number_text(row[key]);
      };
      table.row({number_text(ratio), number("triangles"), number("full_ms"), number("cpu_ms"),
                 number("gpu_ms"), number("full_by_gpu"), number("cpu_by_gpu"), number("psnr"),
                 number("flip")});
    }
    session.print_summary(fmt::format(
        "{}\n{}{}means over {} frames; CPU and GPU: making the level and drawing it\n{}\n", printable(input_),
        table.text(0), gpu ? fmt::format("drawn by {}\n", printable(gpu->device())) : "nothing drawn\n",
        flight_.frames, session.spent_text()));
  }

  /// Means over the frames of a ratio.
  static Json ratio_json(const FlightReport& report, double ratio) {
    std::uint64_t cracks = 0;
    std::vector<double> triangles, full, cpu, gpu, mse, flip, ms_ssim;
    for (const FrameReport& f : report.frames) {
      if (f.ratio != ratio) continue;
      triangles.push_back(static_cast<double>(f.triangles));
      cpu.push_back(f.cpu_update_ms + f.cpu_draw_ms.value_or(0));
      if (f.full_draw_ms) full.push_back(*f.full_draw_ms);
      if (f.gpu_draw_ms) gpu.push_back(*f.gpu_update_ms + *f.gpu_draw_ms);
      cracks += f.cracks;
      if (!f.scores) continue;
      mse.push_back(f.scores->mse);
      flip.push_back(f.scores->flip);
      ms_ssim.push_back(f.scores->ms_ssim);
    }
    const auto or_null = [](const std::vector<double>& values, double value) {
      return values.empty() ? Json() : number_json(value);
    };
    const auto least = [](const std::vector<double>& v) {
      return v.empty() ? 0 : *std::ranges::min_element(v);
    };
    const auto most = [](const std::vector<double>& v) {
      return v.empty() ? 0 : *std::ranges::max_element(v);
    };
    return {{"ratio", ratio},
            {"triangles", std::round(mean(triangles))},
            {"cracks", cracks},
            {"full_ms", or_null(full, mean(full))},
            {"cpu_ms", mean(cpu)},
            {"gpu_ms", or_null(gpu, mean(gpu))},
            {"full_by_gpu", or_null(gpu, mean(full) / mean(gpu))},
            {"cpu_by_gpu", or_null(gpu, mean(cpu) / mean(gpu))},
            {"psnr", or_null(mse, psnr(mean(mse)))},
            {"psnr_worst", or_null(mse, psnr(most(mse)))},
            {"ms_ssim", or_null(ms_ssim, mean(ms_ssim))},
            {"ms_ssim_worst", or_null(ms_ssim, least(ms_ssim))},
            {"flip", or_null(flip, mean(flip))},
            {"flip_worst", or_null(flip, most(flip))}};
  }

  std::string input_, output_, strip_;
  std::string ratios_ = "0.05,0.35,0.6";
  std::vector<double> parsed_ratios_;
  SelectionRule rule_ = SelectionRule::error;
  Device device_ = Device::automatic;
  bool salient_ = false, force_ = false;
  FlightOptions flight_;
  ErrorSelectionOptions selection_;
  ClusterOptions clusters_;
  ClusterSelectionOptions matching_;
  SaliencyOptions saliency_options_;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_fly() { return std::make_unique<Fly>(); }

}  // namespace fovea::cli
