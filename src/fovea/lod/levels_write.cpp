#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/io/gltf_write.h"
#include "fovea/lod/cut.h"
#include "fovea/lod/head_code.h"
#include "fovea/lod/level_chunk.h"
#include "fovea/lod/levels_extension.h"
#include "fovea/lod/levels_file.h"
#include "fovea/lod/levels_round.h"
#include "fovea/lod/split_source.h"

namespace fovea {

namespace {

/// Steps in a chunk: enough to compress well, few enough to be a small step of a download.
constexpr std::uint32_t kChunkSteps = 1 << 13;

void check_has_none(const Model& model) {
  for (const char* name : {"MSFT_lod", kLevelsExtension}) {
    if (std::ranges::find(model.extensions_used, name) != model.extensions_used.end())
      throw Error(ErrorKind::unsupported, fmt::format("the model has levels already ({})", name), "",
                  "give the model that they were made of");
  }
}

/// The chunks from the base on.
void write_levels(ByteWriter& out, const LeveledModel& leveled, Context& context) {
  GrowingModel model;
  SplitSource source(leveled, model);
  SplitCode<SplitSource> code(source, model);
  LevelsHead head;
  for (std::size_t s = 0; s < leveled.levels.step_count(); ++s) head.steps += source.is_taken(s);
  head.triangles = static_cast<std::uint32_t>(leveled.levels.triangles);
  HeadCode<SplitSource>(source, model).code(head);
  for (std::uint32_t m = 0; m < model.meshes.size(); ++m) {
    Split base = source.base(m);
    code.code(base);
  }
  write_chunk(out, ChunkType::base, source.take());
  std::uint32_t count = 0;
  for (std::size_t s = leveled.levels.step_count(); s-- > 0;) {
    if (!source.is_taken(s)) continue;
    Split split = source.undo(s);
    code.code(split);
    if (++count % kChunkSteps != 0 && count != head.steps) continue;
    context.advance_or_throw("encode", count / static_cast<double>(head.steps));
    write_chunk(out, ChunkType::more, source.take());
  }
  write_chunk(out, ChunkType::done, {});
}

/// Scenes keep their numbers, so that both parts of a file fit together.
WriteOptions scene_options(WriteOptions options) {
  options.quantize = false;
  return options;
}

}  // namespace

Model coarsest(const LeveledModel& leveled) {
  return level_of(leveled.original, leveled.levels, cut_leaving_meshes(leveled.original, leveled.levels));
}

std::vector<std::byte> encode_levels(const LeveledModel& leveled, const WriteOptions& options,
                                     Context& context) {
  check_has_none(leveled.original);
  const std::optional<LeveledModel> rounded = rounded_levels(leveled, options);
  const LeveledModel& written = rounded ? *rounded : leveled;
  ByteWriter out;
  write_head(out);
  const GltfOutput scene = write_gltf(coarsest(written), true, "", scene_options(options), context);
  write_chunk(out, ChunkType::scene, scene.files.front().bytes);
  write_levels(out, written, context);
  return std::move(out.bytes);
}

Model with_levels(const LeveledModel& leveled, const WriteOptions& options, Context& context) {
  check_has_none(leveled.original);
  const std::optional<LeveledModel> rounded = rounded_levels(leveled, options);
  const LeveledModel& written = rounded ? *rounded : leveled;
  ByteWriter out;
  write_head(out);
  write_levels(out, written, context);
  Model model = coarsest(written);
  nlohmann::ordered_json json = model.json.empty()
                                    ? nlohmann::ordered_json::object()
                                    : nlohmann::ordered_json::parse(model.json, nullptr, false);
  if (!json.is_object()) throw Error(ErrorKind::usage, "the model's JSON is no object");
  if (json.contains("extensions") && !json["extensions"].is_object()) json.erase("extensions");
  json["extensions"][kLevelsExtension] = {{"bufferView", model.carried_buffer_views.size()}};
  model.json = json.dump();
  model.carried_buffer_views.push_back(std::move(out.bytes));
  return model;
}

}  // namespace fovea
