#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/io/write.h"
#include "fovea/lod/lod_chain.h"

namespace fovea {

/// A level as a GLB.
struct LodFile {
  std::string name;
  std::vector<std::byte> glb;
  ByteCounts bytes;
};

/// One file for each level. `original` is taken for level 0, with its bytes, if it is given and `options` ask
/// for no other way of storing. A level whose file is no smaller than that of the level before is left out of
/// the chain, too, and told ("lod-not-smaller"); so bytes fall from level to level.
///
/// Names come from `pattern`, in which {name} stands for `name` and {i} for the level's number, with ".glb"
/// put behind if it has no such ending. Throws Error(usage) for a pattern without {i} or with a folder in it,
/// and what `write_gltf` throws.
std::vector<LodFile> make_lod_files(LodChain& chain, const std::string& pattern, const std::string& name,
                                    const std::optional<LodFile>& original, const WriteOptions& options,
                                    Context& context);

/// The name that a pattern gives to a level; throws Error(usage) as above.
std::string lod_name(const std::string& pattern, const std::string& name, std::size_t level);

/// All that is known of each level, as a JSON object (docs/levels.md): its keys are "schema_version",
/// "source", "screen", "model" and "levels".
std::string lod_sidecar(const LodChain& chain, const std::vector<LodFile>& files, const std::string& source);

}  // namespace fovea
