#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/io/gltf_read.h"
#include "fovea/lod/head_code.h"
#include "fovea/lod/level_chunk.h"
#include "fovea/lod/levels_extension.h"
#include "fovea/lod/levels_file.h"

namespace fovea {

namespace {

/// Makes a record of steps that come from coarse to fine.
class RecordMaker {
 public:
  void add(const Split& split, std::size_t first_face) {
    CollapseStep step;
    step.kind = split.kind;
    step.moved = split.moved;
    step.mesh = split.mesh;
    step.removed = split.removed;
    step.kept = split.kept;
    step.position = split.coarse_position;
    step.error_rel = split.error_rel;
    steps_.push_back({step, first_face, split.faces, joins_.size(), writes_.size(), floats_.size()});
    joins_.insert(joins_.end(), split.joins.begin(), split.joins.end());
    writes_.insert(writes_.end(), split.writes.begin(), split.writes.end());
    floats_.insert(floats_.end(), split.floats.begin(), split.floats.end());
    error_.push_back(split.error);
  }

  /// From fine to coarse. The errors are the steps'.
  CollapseRecord finish(std::uint64_t triangles, std::vector<float>& error) {
    CollapseRecord record;
    record.triangles_before = triangles;
    std::size_t joins = joins_.size(), writes = writes_.size(), floats = floats_.size();
    for (std::size_t i = steps_.size(); i-- > 0;) {
      const Part& part = steps_[i];
      for (std::size_t f = 0; f < part.faces; ++f)
        record.removed_faces.push_back(FaceId{part.first_face + f});
      append(record.joins, joins_, part.joins, std::exchange(joins, part.joins));
      append(record.writes, writes_, part.writes, std::exchange(writes, part.writes));
      append(record.floats, floats_, part.floats, std::exchange(floats, part.floats));
      CollapseStep& step = record.steps.emplace_back(part.step);
      step.faces_end = static_cast<std::uint32_t>(record.removed_faces.size());
      step.joins_end = static_cast<std::uint32_t>(record.joins.size());
      step.writes_end = static_cast<std::uint32_t>(record.writes.size());
    }
    std::ranges::reverse(error_);
    error = std::move(error_);
    return record;
  }

 private:
  /// A step and where its lists begin.
  struct Part {
    CollapseStep step;
    std::size_t first_face, faces, joins, writes, floats;
  };

  template <class T>
  static void append(std::vector<T>& to, const std::vector<T>& from, std::size_t begin, std::size_t end) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
              from.begin() + static_cast<std::ptrdiff_t>(end));
  }

  std::vector<Part> steps_;
  std::vector<ValueJoin> joins_;
  std::vector<ValueWrite> writes_;
  std::vector<float> floats_, error_;
};

class LevelsReader {
 public:
  LevelsReader(const LevelsReadOptions& levels, std::uint64_t budget, Context& context)
      : options_(levels), budget_(budget), context_(context) {}

  /// Reads the chunks from the base on; a scene is left in `scene`.
  void run(ByteReader& in, std::span<const std::byte>& scene) {
    bool done = false;
    while (!done && (!has_base_ || triangles_ < options_.triangles)) {
      const std::optional<Chunk> chunk = read_chunk(in);
      if (!chunk) {
        if (options_.beginning && has_base_) break;
        damaged_levels("they end too early");
      }
      switch (chunk->type) {
        case ChunkType::scene:
          if (has_base_ || !scene.empty()) damaged_levels("their parts are out of order");
          scene = chunk->content;
          break;
        case ChunkType::base: read_base(chunk->content); break;
        case ChunkType::more: read_more(chunk->content); break;
        case ChunkType::done: done = true; break;
        default: break;  // of a later kind, which one can do without
      }
    }
    if (!has_base_) damaged_levels("their base is missing");
    if (done && (steps_ != head_.steps || triangles_ != head_.triangles))
      damaged_levels("they are not as many as they say");
  }

  /// Puts what was read in the place of the meshes of a scene.
  LeveledModel finish(Model scene) {
    if (scene.meshes.size() != model_.meshes.size()) damaged_levels("the scene has other meshes");
    LeveledModel leveled{std::move(scene), {}};
    for (std::size_t m = 0; m < model_.meshes.size(); ++m) {
      Mesh& mesh = leveled.original.meshes[m];
      TriMesh& surface = model_.meshes[m].surface;
      take_raw_parts(mesh.surface.parts, surface.parts);
      for (const Part& part : surface.parts) {
        if (part.material >= static_cast<int>(leveled.original.materials.size()))
          damaged_levels("a material is not there");
      }
      if (!mesh.morph_weights.empty() && mesh.morph_weights.size() != surface.target_count())
        damaged_levels("the scene has other morph targets");
      mesh.surface = std::move(surface);
      check_surface(mesh.surface);
    }
    std::vector<float> error;
    CollapseRecord record = record_.finish(triangles_, error);
    leveled.levels = make_multi_tessellation(leveled.original, std::move(record), std::move(error), context_);
    return leveled;
  }

 private:
  void read_base(std::span<const std::byte> content) {
    if (has_base_) damaged_levels("their parts are out of order");
    has_base_ = true;
    StreamReader io(content, budget_);
    HeadCode<StreamReader>(io, model_).code(head_);
    SplitCode<StreamReader> code(io, model_);
    for (std::uint32_t m = 0; m < model_.meshes.size(); ++m) {
      Split split;
      code.code(split);
      if (split.kind != StepKind::vanish || split.mesh != m) damaged_levels("their parts are out of order");
      triangles_ += split.faces;
    }
    if (!io.at_end()) damaged_levels("something follows the base");
  }

  void read_more(std::span<const std::byte> content) {
    if (!has_base_) damaged_levels("their parts are out of order");
    StreamReader io(content, budget_);
    SplitCode<StreamReader> code(io, model_);
    while (io.left(Symbol::flags) > 0) {
      Split split;
      code.code(split);
      record_.add(split, model_.meshes[split.mesh].surface.face_count() - split.faces);
      triangles_ += split.faces;
      ++steps_;
    }
    if (!io.at_end()) damaged_levels("something follows the steps");
    context_.advance_or_throw("read",
                              static_cast<double>(steps_) / std::max(1.0, static_cast<double>(head_.steps)));
  }

  /// Points and lines are the scene's.
  static void take_raw_parts(std::vector<Part>& from, std::vector<Part>& to) {
    auto at = from.begin();
    for (Part& part : to) {
      if (!part.raw) continue;
      at = std::find_if(at, from.end(), [](const Part& p) { return p.raw.has_value(); });
      if (at == from.end()) damaged_levels("the scene lacks points or lines");
      part = std::move(*at++);
    }
  }

  static void check_surface(const TriMesh& mesh) {
    try {
      check(mesh);
    } catch (const Error& error) {
      damaged_levels(error.message());
    }
  }

  LevelsReadOptions options_;
  std::uint64_t budget_;
  Context& context_;
  GrowingModel model_;
  LevelsHead head_;
  RecordMaker record_;
  bool has_base_ = false;
  std::uint64_t triangles_ = 0, steps_ = 0;
};

/// Of memory that levels may take.
std::uint64_t budget_of(std::size_t file_bytes, const ReadOptions& options) {
  constexpr std::uint64_t kSmall = 1 << 20;
  const std::uint64_t expanded =
      std::max<std::uint64_t>(file_bytes, kSmall) * static_cast<std::uint64_t>(options.max_expansion);
  return std::min(static_cast<std::uint64_t>(options.max_total_bytes), expanded);
}

}  // namespace

LevelsPlace find_levels(const std::filesystem::path& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return LevelsPlace::none;  // a pipe is read but once
  constexpr std::size_t kHead = 20;
  std::ifstream in(path, std::ios::binary);
  std::string text(kHead, '\0');
  in.read(text.data(), kHead);
  text.resize(static_cast<std::size_t>(in.gcount()));
  const auto bytes = std::as_bytes(std::span(text));
  const FileFormat format = detect_format(bytes, path);
  if (format == FileFormat::fovea) return LevelsPlace::file;
  std::size_t size = std::filesystem::file_size(path, failed);
  if (format == FileFormat::glb && text.size() == kHead) {
    size = std::min<std::size_t>(size, ByteReader(bytes.subspan(12, 4)).number<std::uint32_t>());
  } else if (format != FileFormat::gltf) {
    return LevelsPlace::none;
  }
  text.resize(kHead + size);
  in.clear();
  in.read(text.data() + kHead, static_cast<std::streamsize>(size));
  return text.find(kLevelsExtension) != std::string::npos ? LevelsPlace::inside : LevelsPlace::none;
}

LeveledModel read_levels(std::span<const std::byte> bytes, const std::string& place,
                         const LevelsReadOptions& levels, const ReadOptions& options, Context& context) {
  try {
    ByteReader in(bytes);
    read_head(in);
    LevelsReader reader(levels, budget_of(bytes.size(), options), context);
    std::span<const std::byte> scene;
    reader.run(in, scene);
    if (scene.empty()) damaged_levels("their scene is missing");
    return reader.finish(read_gltf(scene, {}, "scene", options, context));
  } catch (const Error& error) {
    throw error.within(place);
  }
}

std::optional<LeveledModel> levels_inside(const Model& model, const LevelsReadOptions& levels,
                                          const ReadOptions& options, Context& context) {
  if (std::ranges::find(model.extensions_used, kLevelsExtension) == model.extensions_used.end())
    return std::nullopt;
  auto json = nlohmann::ordered_json::parse(model.json, nullptr, false);
  const nlohmann::ordered_json::json_pointer place(std::string("/extensions/") + kLevelsExtension);
  if (json.is_discarded() || !json.contains(place)) return std::nullopt;
  try {
    const auto view = json[place].value("bufferView", model.carried_buffer_views.size());
    if (view >= model.carried_buffer_views.size()) damaged_levels("they are not there");
    const Bytes& bytes = model.carried_buffer_views[view];
    ByteReader in(bytes);
    read_head(in);
    LevelsReader reader(levels, budget_of(bytes.size(), options), context);
    std::span<const std::byte> none;
    reader.run(in, none);
    Model scene = model;
    scene.carried_buffer_views[view] = {};
    json["extensions"].erase(kLevelsExtension);
    if (json["extensions"].empty()) json.erase("extensions");
    scene.json = json.dump();
    std::erase(scene.extensions_used, kLevelsExtension);
    std::erase(scene.extensions_required, kLevelsExtension);
    if (view + 1 == scene.carried_buffer_views.size()) scene.carried_buffer_views.pop_back();
    return reader.finish(std::move(scene));
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorKind::format, "this is no number of a buffer view", place.to_string() + "/bufferView");
  } catch (const Error& error) {
    throw error.within(place.to_string());
  }
}

}  // namespace fovea
