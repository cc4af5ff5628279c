#include "fovea/io/assimp_read.h"

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstring>

#include "fovea/base/error.h"
#include "fovea/io/assimp_scene.h"
#include "fovea/io/byte_budget.h"
#include "fovea/io/child_process.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 7> kImporters = {
    "Autodesk FBX Importer",          "Collada Importer", "Discreet 3DS Importer", "Direct3D XFile Importer",
    "LightWave/Modo Object Importer", "AC3D Importer",    "3mf Importer"};
constexpr std::array<std::string_view, 1> kDumpImporter = {"Assimp Binary Importer"};
constexpr const char* kFormats = "glTF, GLB, OBJ, PLY, STL, OFF, FBX, DAE, 3DS, X, LWO, AC and 3MF";

/// A file in memory for the library to read.
class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}
  explicit MemoryStream(std::vector<std::byte>&& owned) : owned_(std::move(owned)), bytes_(owned_) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0 || count == 0) return 0;
    const std::size_t items = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, items * size);
    at_ += items * size;
    return items;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_CUR ? at_ : origin == aiOrigin_END ? bytes_.size() : 0;
    // The library passes backward steps as wrapped numbers, which this sum unwraps.
    const std::size_t to = base + offset;
    if (to > bytes_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<std::byte> owned_;
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

/// Shows the library the model's bytes and the files beside it, and nothing else.
class FolderSystem final : public Assimp::IOSystem {
 public:
  FolderSystem(std::span<const std::byte> bytes, const fs::path& path, const ReadOptions& options)
      : bytes_(bytes), name_(path.string()), folder_(path.parent_path()), options_(options) {}

  bool Exists(const char* name) const override { return name_ == name || find(name).has_value(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (std::strpbrk(mode, "wa+")) return nullptr;
    if (name_ == name) return new MemoryStream(bytes_);
    const auto file = find(name);
    if (!file) return nullptr;
    return new MemoryStream(read_file(*file, options_.max_file_bytes));
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }
  bool CreateDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

 private:
  /// The library puts the folder before the names that it finds in the file.
  std::optional<fs::path> find(std::string_view name) const {
    const std::string prefix = folder_.string() + "/";
    if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
    return find_side_file(folder_, name);
  }

  std::span<const std::byte> bytes_;
  std::string name_;
  fs::path folder_;
  const ReadOptions& options_;
};

void keep_importers(Assimp::Importer& importer, std::span<const std::string_view> names) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* one = importer.GetImporter(i);
    const aiImporterDesc* description = one->GetInfo();
    if (description && std::find(names.begin(), names.end(), description->mName) != names.end()) continue;
    importer.UnregisterLoader(one);
    delete one;  // the library hands it over when it is taken out
  }
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return text;
}

/// The library's steps and the converter trust indices: none may point outside.
void check_indices(const aiScene& scene, const std::string& place) {
  const auto refuse = [&](const char* message) { throw Error(ErrorKind::format, message, place); };
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (!mesh.mVertices && mesh.mNumVertices > 0) refuse("a mesh has no positions");
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) refuse("a face has an index out of range");
      }
    }
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        if (bone.mWeights[w].mVertexId >= mesh.mNumVertices) refuse("a bone has an index out of range");
      }
    }
  }
}

/// Reads the file and gives the library's own dump of the scene. Runs in a process of its own: some
/// damaged files, and some sound ones, crash the library.
std::vector<std::byte> import_and_dump(std::span<const std::byte> bytes, const fs::path& path,
                                       const ReadOptions& options) {
  const std::string place = path.string();
  Assimp::Importer importer;
  keep_importers(importer, kImporters);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetIOHandler(new FolderSystem(bytes, path, options));  // the importer owns it
  const std::string extension = path.extension().string();
  const bool known = !extension.empty() && importer.IsExtensionSupported(extension.c_str());
  const auto refuse = [&] {
    if (known) throw Error(ErrorKind::format, one_line(importer.GetErrorString()), place);
    throw Error(ErrorKind::unsupported, "this is none of the file formats that can be read", place,
                fmt::format("these can: {}", kFormats));
  };
  const aiScene* scene = importer.ReadFile(place, 0);
  if (!scene) refuse();
  if (scene->mNumMeshes == 0) throw Error(ErrorKind::unsupported, "the file has no triangles", place);
  check_indices(*scene, place);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_FlipUVs |
                                       aiProcess_TransformUVCoords | aiProcess_LimitBoneWeights);
  if (!scene) refuse();
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene, "assbin");
  if (!blob) throw Error(ErrorKind::format, one_line(exporter.GetErrorString()), place);
  const auto* data = static_cast<const std::byte*>(blob->data);
  return {data, data + blob->size};
}

}  // namespace

Model read_assimp(std::span<const std::byte> bytes, const fs::path& path, const ReadOptions& options,
                  Context& context) {
  const std::string place = path.string();
  const std::uint64_t limit = ByteBudget(options, bytes.size()).limit();
  const std::vector<std::byte> dump = run_in_child([&] { return import_and_dump(bytes, path, options); },
                                                   {limit, limit, 600}, place, context);
  Assimp::Importer importer;
  keep_importers(importer, kDumpImporter);
  const aiScene* scene = importer.ReadFileFromMemory(dump.data(), dump.size(), 0, "assbin");
  if (!scene) throw Error(ErrorKind::format, one_line(importer.GetErrorString()), place);
  check_indices(*scene, place);
  return convert_scene(*scene, path.parent_path(), place, options, context);
}

}  // namespace fovea
