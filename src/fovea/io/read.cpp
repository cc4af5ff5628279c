#include "fovea/io/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/io/assimp_read.h"
#include "fovea/io/extension.h"
#include "fovea/io/glb.h"
#include "fovea/io/gltf_read.h"
#include "fovea/io/obj_read.h"
#include "fovea/io/off_read.h"
#include "fovea/io/ply_read.h"
#include "fovea/io/stl_read.h"
#include "fovea/io/text_scan.h"

namespace fovea {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLookedAt = 4096;

FileFormat format_of_extension(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".gltf") return FileFormat::gltf;
  if (extension == ".glb") return FileFormat::glb;
  if (extension == ".obj") return FileFormat::obj;
  if (extension == ".ply") return FileFormat::ply;
  if (extension == ".stl") return FileFormat::stl;
  return FileFormat::other;
}

bool is_json(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

bool is_ply(std::string_view text) {
  return text.starts_with("ply") && text.size() > 3 && std::string_view(" \t\r\n").find(text[3]) != text.npos;
}

/// The first lines are all statements of OBJ, and one of them is about a mesh.
bool is_obj(std::span<const std::byte> head) {
  static constexpr std::string_view kMesh[] = {"v", "f", "vt", "vn", "mtllib", "usemtl", "o", "g"};
  static constexpr std::string_view kOther[] = {"s", "l", "p", "vp"};
  const bool cut = head.size() > kLookedAt;
  TextScanner scan(head.first(std::min(head.size(), kLookedAt)), true);
  bool about_mesh = false;
  while (!scan.at_end()) {
    if (!scan.line_done()) {
      const std::string_view word = scan.word();
      if (scan.at_end() && cut) break;
      const bool mesh = std::find(std::begin(kMesh), std::end(kMesh), word) != std::end(kMesh);
      if (!mesh && std::find(std::begin(kOther), std::end(kOther), word) == std::end(kOther)) return false;
      about_mesh = about_mesh || mesh;
    }
    scan.next_line();
  }
  return about_mesh;
}

Model read_as(FileFormat format, std::span<const std::byte> bytes, const fs::path& path,
              const ReadOptions& options, Context& context) {
  const fs::path folder = path.parent_path();
  const std::string place = path.string();
  switch (format) {
    case FileFormat::glb:
      if (!gltf::is_glb(bytes))
        throw Error(ErrorKind::format, "this is not a GLB file: it does not begin with \"glTF\"", place);
      return read_gltf(bytes, folder, place, options, context);
    case FileFormat::gltf: return read_gltf(bytes, folder, place, options, context);
    case FileFormat::obj: return read_obj(bytes, folder, place, options, context);
    case FileFormat::ply: return read_ply(bytes, folder, place, options, context);
    case FileFormat::stl: return read_stl(bytes, place, options, context);
    case FileFormat::fovea:
      throw Error(ErrorKind::unsupported, "this is a file of levels", place, "read_levels reads it");
    case FileFormat::other: break;
  }
  if (is_off(bytes)) return read_off(bytes, place, options, context);
  return read_assimp(bytes, path, options, context);
}

}  // namespace

OptionList describe(ReadOptions& options) {
  OptionList list;
  list.push_back(
      {"max-file-bytes",
       "Refuse larger input files, images included, so that a mistake does not exhaust the machine.",
       &options.max_file_bytes, "bytes", 1});
  list.push_back({"max-elements", "Refuse files with more vertices or indices than this in one array.",
                  &options.max_elements, "elements", 1});
  list.push_back({"max-total-bytes", "Refuse models whose decoded data is larger than this.",
                  &options.max_total_bytes, "bytes", 1});
  list.push_back(
      {"max-expansion",
       "Refuse models whose decoded data is larger than their files by more than this; files below "
       "1 MiB count as 1 MiB.",
       &options.max_expansion, "times", 1});
  return list;
}

const char* to_string(FileFormat format) {
  switch (format) {
    case FileFormat::gltf: return "gltf";
    case FileFormat::glb: return "glb";
    case FileFormat::obj: return "obj";
    case FileFormat::ply: return "ply";
    case FileFormat::stl: return "stl";
    case FileFormat::fovea: return "fovea";
    case FileFormat::other: break;
  }
  return "other";
}

FileFormat detect_format(std::span<const std::byte> head, const fs::path& path) {
  const std::string_view text = as_text(head);
  const FileFormat by_name = format_of_extension(path);
  if (text.starts_with("glTF")) return FileFormat::glb;
  if (text.starts_with(kLevelsMagic)) return FileFormat::fovea;
  if (is_ply(text)) return FileFormat::ply;
  if (is_stl(head)) return FileFormat::stl;
  if (is_json(text) && (by_name == FileFormat::gltf || text.find("\"asset\"") != text.npos)) {
    return FileFormat::gltf;
  }
  if (is_obj(head)) return FileFormat::obj;
  return by_name;
}

std::vector<std::byte> read_file(const fs::path& path, std::int64_t max_bytes) {
  const std::string place = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw Error(ErrorKind::input, "no such file", place);
  }
  if (fs::is_directory(status)) throw Error(ErrorKind::input, "is a folder", place);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorKind::input, "the file cannot be opened for reading", place);
  // A pipe or device tells no size: it is read piece by piece, up to the same limit.
  const auto told = fs::is_regular_file(status) ? fs::file_size(path, error) : 0;
  const auto limit = static_cast<std::uint64_t>(std::max<std::int64_t>(max_bytes, 0));
  const auto refuse = [&] {
    throw Error(ErrorKind::limit, fmt::format("the file has more than {} bytes", limit), place,
                "raise --max-file-bytes");
  };
  if (told > limit) refuse();
  std::vector<std::byte> bytes;
  for (std::uint64_t next = told + 1;; next = bytes.size() + (std::uint64_t{1} << 20)) {
    const std::size_t have = bytes.size();
    bytes.resize(next);
    stream.read(reinterpret_cast<char*>(bytes.data() + have), static_cast<std::streamsize>(next - have));
    bytes.resize(have + static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > limit) refuse();
    if (!stream) break;
  }
  if (stream.bad()) throw Error(ErrorKind::input, "the file cannot be read to its end", place);
  return bytes;
}

Model read_model(const fs::path& path, const ReadOptions& options, Context& context) {
  const std::vector<std::byte> bytes = read_file(path, options.max_file_bytes);
  if (bytes.empty()) throw Error(ErrorKind::format, "the file is empty", path.string());
  return read_as(detect_format(bytes, path), bytes, path, options, context);
}

}  // namespace fovea
