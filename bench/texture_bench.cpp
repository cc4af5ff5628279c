// What becomes of pictures when textures get smaller, in Fovea's and other ways, as Markdown; an hour or two.
// texture_bench [--quick] [--table N] [--models NAME,...] [--ratio R] [--scale S] [--format webp|jpeg|png]
//               [--psnr DB] [--keep FOLDER]
//   --quick   small pictures from few views of the vase and three models
//   --table   only one of: 1 triangles and texels, 2 equal bytes, 3 seams, 4 baked again
//   --ratio   triangles to keep in table 1, 0.06 without
//   --scale   sides of textures in table 1, 1/16 without
//   --format  files of table 2, WebP without
//   --psnr    how near files of table 2 are to their textures, 40 without
//   --keep    where to put the models of tables 1 and 2

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/budget/picture_loss.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/write.h"
#include "fovea/judge/compare.h"
#include "fovea/model/texture_use.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/salient.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/bake.h"
#include "fovea/texture/image_use.h"
#include "fovea/texture/seam_jump.h"
#include "fovea/texture/shrink.h"
#include "subjects.h"

namespace fovea::bench {
namespace {

struct Request {
  bool quick = false;
  int table = 0;  ///< 0 for all.
  std::vector<std::string> models;
  double ratio = 0.06;
  double scale = 1.0 / 16;
  ImageOutputOptions files{.format = TextureOutput::webp};
  std::string keep;
};

const ImageOutputOptions kWithoutLoss{.format = TextureOutput::png, .psnr_db = 100};

std::uint64_t image_bytes(const Model& model) {
  std::uint64_t sum = 0;
  for (const EncodedImage& image : model.images) sum += image.bytes.size();
  return sum;
}

/// How many colours the base-colour textures of a model have: CD of Yang et al. 2016.
std::size_t distinct_colors(const Model& model) {
  std::set<int> images;
  for (const Material& material : model.materials) {
    const int image = image_of(model, material.base_color);
    if (image >= 0) images.insert(image);
  }
  std::vector<bool> seen(std::size_t{1} << 24);
  for (const int i : images) {
    const Image8 image = decode_image(model.images[static_cast<std::size_t>(i)].bytes);
    for (std::size_t t = 0; t < image.pixels.size(); t += static_cast<std::size_t>(image.channels)) {
      const std::uint8_t* texel = &image.pixels[t];
      const bool is_grey = image.channels < 3;
      seen[static_cast<std::size_t>(texel[0] << 16 | texel[is_grey ? 0 : 1] << 8 | texel[is_grey ? 0 : 2])] =
          true;
    }
  }
  return static_cast<std::size_t>(std::ranges::count(seen, true));
}

// --- Ways to smaller textures ---------------------------------------------------------------------------

/// As other tools resize: each image for itself, as it wraps, whatever lies between the charts.
Model plainly_resized(Model model, double scale, const ImageOutputOptions& output) {
  const Context context;
  const std::vector<ImageUse> uses = image_uses(model);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    EncodedImage& file = model.images[i];
    const ImageUse& use = uses[i];
    const ImageChange::State before = state_of(file);
    if (!use.is_used || use.is_ambiguous || before.width < 1 || before.mime_type == "image/ktx2") continue;
    const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
    const Image8 image = resized(without_idle_alpha(decode_image(file.bytes), use), side(before.width),
                                 side(before.height), use.meaning, use.wrap_u, use.wrap_v, context);
    std::optional<ImageOutput> found = encode_output(image, use, before.mime_type, before.bytes, output);
    if (!found) continue;
    file.mime_type = mime_type(found->format);
    file.bytes = std::move(found->texture.bytes);
  }
  return model;
}

Shrunk shrunk(const Model& model, double scale, const ImageOutputOptions& output, TexelMoves moves,
              std::span<const VertexField> field = {}) {
  Context context;
  ShrinkOptions options;
  options.scale = scale;
  options.output = output;
  options.moves = moves;
  return shrink_textures(model, options, field, context);
}

Model within_bytes(const Model& model, std::uint64_t most, std::int64_t pixels,
                   const ImageOutputOptions& output) {
  Context context;
  ShrinkOptions options;
  options.shown_pixels = static_cast<double>(pixels);
  options.max_bytes = static_cast<std::int64_t>(most);
  options.lost = loss_by_pictures(model, {}, options.shown_pixels, context);
  options.output = output;
  return shrink_textures(model, options, {}, context).model;
}

// --- The protocol of Yang et al. 2016: few triangles, few texels ----------------------------------------

/// A way to make a model small in triangles and in texels.
struct Way {
  std::string name;
  std::function<Model(const Model&, const Request&)> run;
};

Model simplified(const Model& model, const Request& request, Metric metric,
                 const Importance& importance = {}) {
  Context context;
  SimplifyOptions options;
  options.ratio = request.ratio;
  options.metric = metric;
  return simplify(model, options, importance, context).model;
}

std::vector<VertexField> saliency(const Model& model, SaliencyPreset preset) {
  Context context;
  SaliencyOptions options;
  options.preset = preset;
  return model_saliency(model, options, context).saliency;
}

Model salient(const Model& model, const Request& request, SaliencyPreset preset,
              SaliencyWeighting weighting) {
  SalientOptions options;
  options.weighting = weighting;
  const Context context;
  return simplified(model, request, Metric::quadric,
                    salient_importance(model, saliency(model, preset), options, context));
}

Model by_resizing(const Model& model, const Request& request) {
  return plainly_resized(simplified(model, request, Metric::quadric), request.scale, kWithoutLoss);
}

Model by_lee(const Model& model, const Request& request) {
  return shrunk(salient(model, request, SaliencyPreset::lee, SaliencyWeighting::lee), request.scale,
                kWithoutLoss, TexelMoves::frequency)
      .model;
}

Model by_yang(const Model& model, const Request& request) {
  const Model small = salient(model, request, SaliencyPreset::yang, SaliencyWeighting::yang);
  return shrunk(small, request.scale, kWithoutLoss, TexelMoves::saliency,
                saliency(small, SaliencyPreset::yang))
      .model;
}

Model simplified_by_us(const Model& model, const Request& request) {
  return simplified(model, request, Metric::automatic);
}

Model by_us_resized(const Model& model, const Request& request) {
  return plainly_resized(simplified_by_us(model, request), request.scale, kWithoutLoss);
}

Model by_us(const Model& model, const Request& request) {
  return shrunk(simplified_by_us(model, request), request.scale, kWithoutLoss, TexelMoves::balanced).model;
}

Model by_us_rebaked(const Model& model, const Request& request, bool normals) {
  ShrinkOptions options;
  options.scale = request.scale;
  options.output = kWithoutLoss;
  options.rebake = {&model, normals};
  Context context;
  return shrink_textures(simplified_by_us(model, request), options, {}, context).model;
}

/// The first is what the others are held against.
std::vector<Way> all_ways() {
  return {{"qem+resize", by_resizing},
          {"lee+relax", by_lee},
          {"yang", by_yang},
          {"ours+resize", by_us_resized},
          {"ours", by_us},
          {"ours+rebake", [](const Model& m, const Request& r) { return by_us_rebaked(m, r, false); }},
          {"ours+normals", [](const Model& m, const Request& r) { return by_us_rebaked(m, r, true); }}};
}

CompareOptions judge(const Request& request) {
  CompareOptions options;
  options.distance_samples = 0;
  if (request.quick) {
    options.size = 256;
    options.views.set = ViewSet::octahedron;
  }
  return options;
}

std::vector<Comparison> compared(const Model& model, std::span<const Model> tests, const Request& request) {
  std::vector<const Model*> pointers;
  for (const Model& test : tests) pointers.push_back(&test);
  Context context;
  return compare(model, pointers, judge(request), context);
}

void keep(const Model& model, const std::string& name, const Request& request) {
  if (request.keep.empty()) return;
  Context context;
  WriteOptions options;
  options.force = true;
  std::filesystem::create_directories(request.keep);
  write_model(model, std::filesystem::path(request.keep) / (name + ".glb"), options, context);
}

void print_protocol(const std::vector<Subject>& subjects, const Request& request) {
  const std::vector<Way> ways = all_ways();
  fmt::print(
      "## Few triangles and few texels\n\n"
      "Triangles to {:g} %, sides of textures to {:g} %, no loss by files. CD: colours of the base-colour "
      "textures.\n\n"
      "| model | CD | triangles | way | PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit |\n"
      "|---|--:|--:|---|--:|--:|--:|--:|\n",
      100 * request.ratio, 100 * request.scale);
  struct Sum {
    std::array<double, 2> psnr{}, ms_ssim{};
    std::array<int, 2> firsts{};
  };
  std::vector<Sum> sums(ways.size());
  for (const Subject& subject : subjects) {
    const Model model = subject.make();
    std::vector<Model> results;
    for (const Way& way : ways) {
      fmt::print(stderr, "texture_bench: {}: {}\n", subject.name, way.name);
      results.push_back(way.run(model, request));
      keep(results.back(), subject.name + "-" + way.name, request);
    }
    const std::vector<Comparison> found = compared(model, results, request);
    for (std::size_t w = 0; w < ways.size(); ++w) {
      const ImageScores &base = found[w][JudgedPass::base_color], &lit = found[w][JudgedPass::lit];
      fmt::print("| {} | {} | {} | {} | {:.2f} | {:.4f} | {:.2f} | {:.4f} |\n", w == 0 ? subject.name : "",
                 w == 0 ? fmt::to_string(distinct_colors(model)) : "", triangle_count(results[w]),
                 ways[w].name, base.psnr, base.ms_ssim, lit.psnr, lit.ms_ssim);
      for (std::size_t p = 0; p < 2; ++p) {
        const auto psnr = [&](std::size_t way) { return found[way].passes[p].psnr; };
        sums[w].psnr[p] += psnr(w) - psnr(0);
        sums[w].ms_ssim[p] += found[w].passes[p].ms_ssim - found[0].passes[p].ms_ssim;
        bool is_first = true;
        for (std::size_t other = 0; other < ways.size(); ++other)
          is_first = is_first && psnr(w) >= psnr(other);
        sums[w].firsts[p] += is_first;
      }
    }
    std::fflush(stdout);
  }
  fmt::print(
      "\nMean gain over {} ({} models), and of how many the PSNR is the best:\n\n"
      "| way | PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit | first base | first lit |\n"
      "|---|--:|--:|--:|--:|--:|--:|\n",
      ways[0].name, subjects.size());
  const auto n = static_cast<double>(subjects.size());
  for (std::size_t w = 0; w < ways.size(); ++w) {
    fmt::print("| {} | {:+.2f} | {:+.4f} | {:+.2f} | {:+.4f} | {} | {} |\n", ways[w].name,
               sums[w].psnr[0] / n, sums[w].ms_ssim[0] / n, sums[w].psnr[1] / n, sums[w].ms_ssim[1] / n,
               sums[w].firsts[0], sums[w].firsts[1]);
  }
  fmt::print("\n");
}

// --- Equal bytes ----------------------------------------------------------------------------------------

/// The model's images in files without loss, so that none is kept because it would grow.
Model without_loss(Model model) {
  for (EncodedImage& file : model.images) {
    const ImageChange::State state = state_of(file);
    if (state.width < 1 || state.mime_type == "image/ktx2") continue;
    file.bytes = encode_png(decode_image(file.bytes));
    file.mime_type = "image/png";
  }
  return model;
}

/// A model with smaller textures in files, which differ from the textures by `psnr_db`.
struct Fit {
  Model model;
  double psnr_db = 0;
  std::uint64_t bytes = 0;
};

/// Triangles that show each image of a model; none where they are not all known.
std::vector<std::vector<AtlasFace>> faces_of_images(const Model& model) {
  std::vector<std::vector<AtlasFace>> result(model.images.size());
  for (const Atlas& atlas : find_atlases(model)) {
    if (!atlas.fixed_because.empty()) continue;
    for (const int image : atlas.images) result[static_cast<std::size_t>(image)] = atlas_faces(model, atlas);
  }
  return result;
}

/// `small` with files as near as no more than `most` bytes allow. No file is larger than that of `original`.
Fit fitted(const Model& original, const Model& small, std::uint64_t most, const Request& request) {
  constexpr int kTries = 7;
  const std::vector<ImageUse> uses = image_uses(original);
  const std::vector<std::vector<AtlasFace>> faces = faces_of_images(small);
  const Context context;
  Fit best;
  double low = 20, high = 60;
  for (int i = 0; i < kTries; ++i) {
    ImageOutputOptions output = request.files;
    output.psnr_db = i == 0 ? request.files.psnr_db : (low + high) / 2;
    Fit next{small, output.psnr_db, 0};
    for (std::size_t n = 0; n < uses.size(); ++n) {
      const EncodedImage& before = original.images[n];
      EncodedImage& file = next.model.images[n];
      std::optional<ImageOutput> found;
      if (uses[n].is_used && !uses[n].is_ambiguous && state_of(before).width > 0) {
        const Image8 image = without_idle_alpha(decode_image(file.bytes), uses[n]);
        found = encode_output(image, uses[n], before.mime_type, before.bytes.size(), output,
                              read_texels(faces[n], image.width, image.height, context));
      }
      file.mime_type = found ? mime_type(found->format) : before.mime_type;
      file.bytes = found ? std::move(found->texture.bytes) : before.bytes;
    }
    next.bytes = image_bytes(next.model);
    (next.bytes <= most ? low : high) = next.psnr_db;
    if (next.bytes <= most && next.bytes > best.bytes) best = std::move(next);
  }
  return best;
}

/// What a way gains over another, over all models.
struct Gains {
  double psnr = 0, ms_ssim = 0, log_flip = 0;
  int better = 0, worse = 0;
  double worst = 0;
  std::string_view worst_model;
  void add(const ImageScores& own, const ImageScores& plain, std::string_view model) {
    psnr += own.psnr == plain.psnr ? 0 : own.psnr - plain.psnr;  // both infinite for what looks the same
    ms_ssim += own.ms_ssim - plain.ms_ssim;
    log_flip += own.flip == plain.flip ? 0 : std::log(own.flip / plain.flip);
    count(own.psnr == plain.psnr ? 0 : own.psnr - plain.psnr, model);
  }
  void count(double gain, std::string_view model) {
    constexpr double kTold = 0.005;  // dB that still show in two digits
    better += gain >= kTold;
    worse += gain <= -kTold;
    if (gain > -kTold || gain >= worst) return;
    worst = gain;
    worst_model = model;
  }
  std::string at_most() const {
    return worst == 0 ? "0.00" : fmt::format("{:+.2f} ({})", worst, worst_model);
  }
};

void print_equal_bytes(const std::vector<Subject>& subjects, const Request& request) {
  constexpr std::array<const char*, 3> kNames{"plain", "sides", "bytes"};
  constexpr std::array kParts{2, 4, 8};
  fmt::print(
      "## Equal bytes\n\n"
      "Textures alone, in the bytes that plain resizing takes: resized plainly; to the same sides, with "
      "texels moved where that gains, and as near as the bytes allow (dB is how near); and with sizes and "
      "qualities chosen for the bytes, by pictures of this size.\n\n"
      "| model | side | way | kB | dB | PSNR base | MS-SSIM base | FLIP base | PSNR lit | MS-SSIM lit | FLIP "
      "lit |\n"
      "|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  std::array<std::array<std::array<Gains, 2>, 3>, 3> sums{};
  std::array<std::array<Gains, 3>, 3> both{};  // PSNR of the passes together
  for (const Subject& subject : subjects) {
    const Model model = subject.make();
    const Model large = without_loss(model);
    for (std::size_t d = 0; d < kParts.size(); ++d) {
      const double scale = 1.0 / kParts[d];
      std::vector<Model> results{plainly_resized(model, scale, request.files)};
      const std::uint64_t most = image_bytes(results[0]);
      std::array<double, 3> near{request.files.psnr_db};
      Fit fit = fitted(model, shrunk(large, scale, kWithoutLoss, TexelMoves::balanced).model, most, request);
      near[1] = fit.psnr_db;
      results.push_back(fit.bytes > 0 ? std::move(fit.model) : model);
      results.push_back(within_bytes(model, most, judge(request).size, request.files));
      const std::vector<Comparison> found = compared(model, results, request);
      for (std::size_t w = 0; w < results.size(); ++w) {
        keep(results[w], fmt::format("{}-{}-{}", subject.name, kParts[d], kNames[w]), request);
        fmt::print("| {} | {} | {} | {:.1f} | {:.1f} |", d + w == 0 ? subject.name : "",
                   w == 0 ? fmt::format("1/{}", kParts[d]) : "", kNames[w],
                   static_cast<double>(image_bytes(results[w])) / 1000, near[w]);
        for (std::size_t p = 0; p < 2; ++p) {
          const ImageScores &plain = found[0].passes[p], &own = found[w].passes[p];
          fmt::print(" {:.2f} | {:.5f} | {:.4f} |", own.psnr, own.ms_ssim, own.flip);
          sums[d][w][p].add(own, plain, subject.name);
        }
        const auto psnr = [&](std::size_t n) {
          return (found[n].passes[0].psnr + found[n].passes[1].psnr) / 2;
        };
        const double gain = psnr(w) == psnr(0) ? 0 : psnr(w) - psnr(0);
        both[d][w].psnr += gain;
        both[d][w].count(gain, subject.name);
        fmt::print("\n");
      }
      std::fflush(stdout);
    }
  }
  fmt::print(
      "\nMeans against plain: difference of PSNR (dB) and MS-SSIM, geometric mean of the ratio of FLIP; in "
      "how many models PSNR is better or worse by 0.01 dB at least, and by how much at most.\n\n"
      "| side | way | pass | PSNR | MS-SSIM | FLIP | better | worse | at most |\n"
      "|--:|---|---|--:|--:|--:|--:|--:|--:|\n");
  const auto n = static_cast<double>(subjects.size());
  for (std::size_t d = 0; d < kParts.size(); ++d) {
    for (std::size_t w = 1; w < kNames.size(); ++w) {
      for (std::size_t p = 0; p < 2; ++p) {
        const Gains& sum = sums[d][w][p];
        fmt::print("| 1/{} | {} | {} | {:+.2f} | {:+.5f} | {:.3f} | {} | {} | {} |\n", kParts[d], kNames[w],
                   p == 0 ? "base" : "lit", sum.psnr / n, sum.ms_ssim / n, std::exp(sum.log_flip / n),
                   sum.better, sum.worse, sum.at_most());
      }
      const Gains& sum = both[d][w];
      fmt::print("| 1/{} | {} | both | {:+.2f} | | | {} | {} | {} |\n", kParts[d], kNames[w], sum.psnr / n,
                 sum.better, sum.worse, sum.at_most());
    }
  }
  fmt::print("\n");
}

// --- Seams ----------------------------------------------------------------------------------------------

void print_seams(const std::vector<Subject>& subjects) {
  fmt::print(
      "## Seams\n\n"
      "Mean jump of the base colour across seams, in 255ths: of the original, plainly resized, resized from "
      "filled images, and ours.\n\n"
      "| model | edges | original | plain 1/4 | filled | ours | plain 1/16 | filled | ours |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Subject& subject : subjects) {
    const Model model = subject.make();
    const auto jump = [](const Model& of) {
      Context context;
      return seam_jump(of, context);
    };
    const SeamJump before = jump(model);
    fmt::print("| {} | {} | {:.2f} |", subject.name, before.edges, 255 * before.mean);
    for (const double scale : {1.0 / 4, 1.0 / 16}) {
      fmt::print(" {:.2f} | {:.2f} | {:.2f} |", 255 * jump(plainly_resized(model, scale, kWithoutLoss)).mean,
                 255 * jump(shrunk(model, scale, kWithoutLoss, TexelMoves::none).model).mean,
                 255 * jump(shrunk(model, scale, kWithoutLoss, TexelMoves::balanced).model).mean);
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
  fmt::print("\n");
}

// --- Baked again ----------------------------------------------------------------------------------------

void print_rebaked(const std::vector<Subject>& subjects, const Request& request) {
  constexpr std::array kRatios{0.1, 0.05, 0.02};
  constexpr std::array<const char*, 2> kNames{"baked again", "with normals"};
  fmt::print(
      "## Baked again\n\n"
      "Simplified by us, images of half the sides and without loss: what is gained over plain resizing by "
      "baking "
      "again, and by new normal maps besides; PSNR and FLIP, base colour / lit. At their own sides files "
      "could only "
      "grow, and stay.\n\n"
      "| model | way | 10 % of the triangles | 5 % | 2 % |\n"
      "|---|---|---|---|---|\n");
  for (const Subject& subject : subjects) {
    const Model model = without_loss(subject.make());
    std::array<std::string, kNames.size()> rows;
    for (const double ratio : kRatios) {
      Request wanted = request;
      wanted.ratio = ratio;
      wanted.scale = 0.5;
      const std::vector<Model> results{by_us_resized(model, wanted), by_us_rebaked(model, wanted, false),
                                       by_us_rebaked(model, wanted, true)};
      const std::vector<Comparison> found = compared(model, results, request);
      for (std::size_t w = 0; w < kNames.size(); ++w) {
        const auto& resized = found[0].passes;
        const auto& baked = found[w + 1].passes;
        const auto flip = [&](std::size_t pass) { return 100 * (baked[pass].flip / resized[pass].flip - 1); };
        rows[w] +=
            fmt::format(" {:+.2f} / {:+.2f} dB, {:+.0f} / {:+.0f} % |", baked[0].psnr - resized[0].psnr,
                        baked[1].psnr - resized[1].psnr, flip(0), flip(1));
      }
    }
    for (std::size_t w = 0; w < kNames.size(); ++w)
      fmt::print("| {} | {} |{}\n", w == 0 ? subject.name : "", kNames[w], rows[w]);
    std::fflush(stdout);
  }
  fmt::print("\n");
}

// --- Command line ---------------------------------------------------------------------------------------

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

Request request_of(std::span<char* const> words) {
  Request request;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = words[i];
    if (name == "--quick") {
      request.quick = true;
      continue;
    }
    if (i + 1 == words.size()) throw Error(ErrorKind::usage, name + " is unknown or needs a value");
    const std::string value = words[++i];
    if (name == "--table") {
      request.table = std::stoi(value);
    } else if (name == "--models") {
      request.models = parts_of(value);
    } else if (name == "--ratio") {
      request.ratio = std::stod(value);
    } else if (name == "--scale") {
      request.scale = std::stod(value);
    } else if (name == "--psnr") {
      request.files.psnr_db = std::stod(value);
    } else if (name == "--format") {
      OptionList options = describe(request.files);
      options[0].parse(value);
    } else if (name == "--keep") {
      request.keep = value;
    } else {
      throw Error(ErrorKind::usage, name + " is unknown");
    }
  }
  if (request.quick && request.models.empty()) request.models = {"vase", "WaterBottle", "Avocado", "BoomBox"};
  return request;
}

int run(int count, char** arguments) {
  try {
    const Request request = request_of({arguments + 1, arguments + count});
    std::vector<Subject> subjects = texture_subjects();
    std::erase_if(subjects, [&](const Subject& subject) {
      return !request.models.empty() &&
             std::ranges::find(request.models, subject.name) == request.models.end();
    });
    if (subjects.empty())
      throw Error(ErrorKind::usage, "there is none of these models", "--models",
                  "those that are not samples need FOVEA_DATA");
    const CompareOptions options = judge(request);
    fmt::print("{} models; pictures of {}², base colour and lit.\n\n", subjects.size(), options.size);
    if (request.table == 0 || request.table == 1) print_protocol(subjects, request);
    if (request.table == 0 || request.table == 2) print_equal_bytes(subjects, request);
    if (request.table == 0 || request.table == 3) print_seams(subjects);
    if (request.table == 0 || request.table == 4) print_rebaked(subjects, request);
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "texture_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** arguments) { return fovea::bench::run(count, arguments); }
