// The pieces of docs/library.md, one after the other: library_tour INPUT FOLDER.

#include <array>
#include <filesystem>
#include <iostream>

#include "fovea/base/error.h"
#include "fovea/budget/fit.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/judge/compare.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/levels_file.h"
#include "fovea/lod/lod_chain.h"
#include "fovea/saliency/model_saliency.h"
#include "fovea/simplify/salient.h"
#include "fovea/simplify/simplify.h"
#include "fovea/texture/shrink.h"

namespace {

void tour(const std::filesystem::path& input, const std::filesystem::path& folder) {
  // [context]
  fovea::Context context;
  context.threads = 2;  // results are the same for any number; 0 takes all
  context.progress = [](std::string_view phase, double done) {
    std::cerr << phase << ' ' << static_cast<int>(100 * done) << " %\r";
    return true;  // false cancels
  };
  // [/context]

  // [read]
  const fovea::Model model = fovea::read_model(input, {}, context);
  for (const fovea::Mesh& mesh : model.meshes)
    std::cout << mesh.name << ": " << mesh.surface.face_count() << " triangles, "
              << mesh.surface.vertex_count() << " vertices\n";
  // [/read]

  // [simplify]
  fovea::SimplifyOptions options;
  options.ratio = 0.1;
  const fovea::SimplifyResult small = fovea::simplify(model, options, {}, context);
  if (small.stop == fovea::StopReason::stuck)
    std::cerr << small.blocked.edges << " edges are left that may not collapse\n";
  fovea::write_model(small.model, folder / "small.glb", {}, context);
  // [/simplify]

  // [replay]
  const std::size_t steps = small.record.steps_to(small.triangles_before / 2);
  const fovea::Model half = fovea::replay(model, small.record, steps);
  // [/replay]

  // [importance]
  const fovea::ModelSaliency seen = fovea::model_saliency(model, {}, context);
  fovea::Importance importance = fovea::salient_importance(model, seen.saliency, {}, context);
  for (float& weight : importance[0].values()) weight *= 2;  // or what you know yourself; infinity locks
  const fovea::Model salient = fovea::simplify(model, options, importance, context).model;
  // [/importance]

  // [compare]
  const std::array<const fovea::Model*, 3> tests{&small.model, &half, &salient};
  fovea::CompareOptions judge;
  judge.size = 128;  // pixels along a view, 512 by itself
  for (const fovea::Comparison& found : fovea::compare(model, tests, judge, context)) {
    const fovea::ImageScores& lit = found[fovea::JudgedPass::lit];
    std::cout << lit.psnr << " dB, FLIP " << lit.flip << '\n';
  }
  // [/compare]

  // [textures]
  fovea::ShrinkOptions textures;
  textures.scale = 0.5;
  textures.output.format = fovea::TextureOutput::webp;
  textures.rebake.original = &model;  // texels show what the original has where the simpler surface is
  const fovea::Shrunk shrunk = fovea::shrink_textures(small.model, textures, {}, context);
  // [/textures]

  // [fit]
  fovea::FitOptions budget;
  budget.view_size = 128;
  fovea::BudgetFit fit(model, budget, context);
  const fovea::FitResult best = fit.within(shrunk.bytes + 100'000);
  std::cout << best.chosen.bytes << " bytes, " << best.chosen.triangles << " triangles\n";
  // [/fit]

  // [levels]
  fovea::MultiTessellation levels = fovea::make_multi_tessellation(model, small.record, context);
  const fovea::Cut cut = fovea::cut_at_error(levels, 0.001 * bounds(model).diagonal());
  const fovea::Model level = fovea::level_of(model, levels, cut);
  const std::vector<std::byte> file = fovea::encode_levels({model, std::move(levels)}, {}, context);
  // [/levels]
  std::cout << file.size() << " bytes for all levels\n";

  // [chain]
  fovea::LodChainOptions chain;
  chain.triangles = {static_cast<std::int64_t>(small.triangles_before / 4),
                     static_cast<std::int64_t>(small.triangles_before / 16)};
  chain.pictures = false;
  for (const fovea::LodLevel& l : fovea::make_lod_chain(model, chain, {}, context).levels)
    std::cout << l.triangles << " triangles from " << l.distance << " on, error " << l.error.max << '\n';
  // [/chain]

  // [diagnostics]
  for (const fovea::Diagnostic& d : context.diagnostics())
    std::cerr << d.code << ", " << d.place << ": " << d.message << " (" << d.count << ")\n";
  // [/diagnostics]
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << "usage: library_tour INPUT FOLDER\n";
    return 2;
  }
  // [error]
  try {
    tour(words[1], words[2]);
    return 0;
  } catch (const fovea::Error& error) {
    std::cerr << error.what() << '\n' << error.hint() << '\n';
    return fovea::exit_code(error.kind());
  }
  // [/error]
}
