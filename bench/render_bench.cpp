// Time to draw 24 views with Fovea's renderer, Mesa's llvmpipe and Embree, as Markdown.
// render_bench [--quick] [MODEL-NAME...]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/model/image_error.h"
#include "fovea/render/render.h"
#include "measure.h"
#include "render_peers.h"
#include "subjects.h"

namespace fovea::bench {
namespace {

/// A model with what drawing it needs.
struct Drawable {
  Model model;
  RenderScene scene;
  ViewJob job;
};

std::shared_ptr<const Drawable> prepare(const Subject& subject, int threads, int size = 512) {
  Context context;
  auto all = std::make_shared<Drawable>();
  all->model = subject.make();
  all->scene = make_render_scene(all->model, rest_pose(all->model), context);
  all->job = {&all->scene, make_views({}, all->scene.sphere), size, threads};
  return all;
}

std::vector<Picture> draw(const Drawable& all, Pass pass) {
  Context context;
  context.threads = all.job.threads;
  RenderOptions options;
  options.pass = pass;
  options.width = options.height = all.job.size;
  return render_views(all.scene, all.job.views, options, context);
}

/// Samples that Fovea covers, four per pixel.
std::uint64_t covered_samples(const std::vector<Picture>& pictures) {
  double sum = 0;
  for (const Picture& picture : pictures) {
    for (const std::uint8_t c : picture.coverage.pixels) sum += c / 255.0;
  }
  return static_cast<std::uint64_t>(std::llround(4 * sum));
}

Cost measure_fovea(const Subject& subject, Pass pass, int threads, int repeats, int size = 512) {
  return measure(
      [&]() -> Work {
        auto all = prepare(subject, threads, size);
        return [all, pass] { return covered_samples(draw(*all, pass)); };
      },
      repeats);
}

Cost measure_embree(const Subject& subject, int threads, int repeats) {
  return measure(
      [&]() -> Work {
        auto all = prepare(subject, threads);
        return [all, work = embree_peer(all->job)] { return work(); };
      },
      repeats);
}

Cost measure_llvmpipe([[maybe_unused]] const Subject& subject, [[maybe_unused]] int threads,
                      [[maybe_unused]] int repeats) {
#ifdef FOVEA_BENCH_LLVMPIPE
  return measure(
      [&]() -> Work {
        auto all = prepare(subject, threads);
        return [all, work = llvmpipe_peer(all->job)]() -> std::uint64_t { return work().size(); };
      },
      repeats);
#else
  return {};
#endif
}

/// PSNR between Fovea's pictures and llvmpipe's, in thousandths of a dB: that both draw the same.
std::uint64_t likeness([[maybe_unused]] const Subject& subject) {
#ifdef FOVEA_BENCH_LLVMPIPE
  return measure(
             [&]() -> Work {
               auto all = prepare(subject, 2);
               return [all, work = llvmpipe_peer(all->job)]() -> std::uint64_t {
                 const std::vector<Picture> ours = draw(*all, Pass::base_color);
                 const std::vector<Image8> theirs = work();
                 double sum = 0;
                 for (std::size_t i = 0; i < ours.size(); ++i)
                   sum += mean_squared_error(ours[i].color, theirs[i]) / static_cast<double>(ours.size());
                 return static_cast<std::uint64_t>(1000 * psnr(sum));
               };
             },
             1)
      .result;
#else
  return 0;
#endif
}

std::string time_text(double seconds) { return seconds > 0 ? fmt::format("{:.2f}", seconds) : "–"; }
std::string ratio_text(double theirs, double ours) {
  return theirs > 0 && ours > 0 ? fmt::format("{:.2f}×", theirs / ours) : "–";
}

void print_row(const Subject& subject, int repeats) {
  const std::uint64_t triangles =
      measure([&]() -> Work { return [all = prepare(subject, 1)] { return all->scene.triangle_count; }; }, 1)
          .result;
  const Cost setup = measure_fovea(subject, Pass::triangle, 2, repeats, 8);
  const Cost ids = measure_fovea(subject, Pass::triangle, 2, repeats);
  const Cost base = measure_fovea(subject, Pass::base_color, 2, repeats);
  const Cost lit = measure_fovea(subject, Pass::lit, 2, repeats);
  const Cost one = measure_fovea(subject, Pass::base_color, 1, repeats);
  const Cost pipe = measure_llvmpipe(subject, 2, repeats);
  const Cost rays = measure_embree(subject, 2, repeats);
  const std::uint64_t like = pipe.wall_seconds > 0 ? likeness(subject) : 0;
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", subject.name, triangles,
             time_text(setup.wall_seconds), time_text(ids.wall_seconds), time_text(base.wall_seconds),
             time_text(lit.wall_seconds), time_text(one.wall_seconds), time_text(pipe.wall_seconds),
             time_text(rays.wall_seconds), ratio_text(pipe.wall_seconds, base.wall_seconds),
             ratio_text(rays.wall_seconds, ids.wall_seconds),
             like > 0 ? fmt::format("{:.1f} dB", static_cast<double>(like) / 1000) : "–",
             rays.result > 0
                 ? fmt::format("{:.4f}", static_cast<double>(ids.result) / static_cast<double>(rays.result))
                 : "–");
  std::fflush(stdout);
}

int run(int count, char** words) {
  try {
    int repeats = 3;
    std::vector<std::string> only;
    for (int i = 1; i < count; ++i) {
      if (std::strcmp(words[i], "--quick") == 0) {
        repeats = 1;
      } else {
        only.emplace_back(words[i]);
      }
    }
    fmt::print(
        "Seconds for 24 views of 512 × 512 pixels with four samples each, two threads, everything loaded; "
        "best "
        "of {}. Above 1× fovea is faster.\n\n"
        "| model | triangles | fovea: set-up | ids | base colour | lit | base, 1 thread | llvmpipe: base "
        "colour | embree: ids | fovea : llvmpipe | fovea : embree | like llvmpipe's | samples : embree's |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
        repeats);
    for (const Subject& subject : render_subjects()) {
      if (only.empty() || std::find(only.begin(), only.end(), subject.name) != only.end())
        print_row(subject, repeats);
    }
    return 0;
  } catch (const Error& error) {
    fmt::print(stderr, "render_bench: {}\n", error.what());
    return exit_code(error.kind());
  }
}

}  // namespace
}  // namespace fovea::bench

int main(int count, char** words) { return fovea::bench::run(count, words); }
