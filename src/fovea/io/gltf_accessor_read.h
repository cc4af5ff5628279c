#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "fovea/io/byte_budget.h"
#include "fovea/io/gltf_json.h"
#include "fovea/io/read.h"
#include "fovea/model/accessor.h"

// Private to io: the binary side of reading glTF.

namespace fovea::gltf {

/// What an accessor says of itself.
struct AccessorShape {
  Storage storage;
  int width = 1;
  bool matrix = false;
  std::size_t count = 0;

  std::size_t byte_size() const { return count * static_cast<std::size_t>(width) * size_of(storage.type); }
};

/// Reads buffers, buffer views and accessors of one file, each buffer when it is first needed. Every
/// extent is checked against the data before anything is allocated for it.
class DataReader {
 public:
  /// `root` and `binary` (the BIN chunk of a GLB) must outlive the reader.
  DataReader(const JsonView& root, std::optional<std::span<const std::byte>> binary,
             std::filesystem::path folder, const ReadOptions& options, ByteBudget& budget);

  std::size_t accessor_count() const { return accessors_.size(); }
  std::size_t view_count() const { return views_.size(); }

  /// Index of the accessor that `reference` names. Throws Error(format) if there is no such.
  int accessor_index(const JsonView& reference) const {
    return reference.index(accessors_.size(), "accessors");
  }
  int view_index(const JsonView& reference) const { return reference.index(views_.size(), "buffer views"); }

  /// Type and count, checked against ReadOptions::max_elements; the data is not looked at.
  AccessorShape shape(int accessor) const;
  /// The accessor's numbers, sparse values in place, packed.
  Accessor read(int accessor);
  /// The bytes of a buffer view, decompressed. Valid as long as the reader.
  std::span<const std::byte> view(int view);
  /// A file beside the model, within the limits; its bytes are charged. Throws Error(input), Error(format),
  /// Error(limit) with the place of `at`.
  std::vector<std::byte> side_file(const std::string& relative_path, const JsonView& at);

 private:
  std::span<const std::byte> buffer(int buffer);
  std::vector<std::byte> load_uri(const JsonView& uri);
  std::span<const std::byte> range(int buffer, std::uint64_t offset, std::uint64_t length,
                                   const JsonView& at);
  std::span<const std::byte> compressed_view(int view, const JsonView& extension);
  void read_dense(int accessor, const AccessorShape& shape, std::vector<std::byte>& bytes);
  void read_sparse(const JsonView& sparse, const AccessorShape& shape, std::vector<std::byte>& bytes);

  std::vector<JsonView> buffers_;
  std::vector<JsonView> views_;
  std::vector<JsonView> accessors_;
  std::optional<std::span<const std::byte>> binary_;
  std::filesystem::path folder_;
  const ReadOptions& options_;
  ByteBudget& budget_;
  std::set<std::filesystem::path> side_files_;
  std::map<int, std::vector<std::byte>> loaded_buffers_;
  std::map<int, std::vector<std::byte>> decoded_views_;
};

/// The numbers of an accessor of unsigned integers.
std::vector<std::uint32_t> to_indices(const Accessor& accessor);

}  // namespace fovea::gltf
