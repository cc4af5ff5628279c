#include "fovea/io/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "fovea/base/error.h"
#include "fovea/base/text.h"
#include "fovea/io/extension.h"
#include "fovea/io/gltf_write.h"
#include "fovea/io/obj_write.h"
#include "fovea/io/ply_write.h"

namespace fovea {

namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void check_folder(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) {
    throw Error(ErrorKind::output, "the folder does not exist", folder.string(), "make it first");
  }
  if (!fs::is_directory(status)) throw Error(ErrorKind::output, "this is not a folder", folder.string());
}

/// What stands where a file is to go. Never throws for a missing one.
fs::file_status status_of(const fs::path& path) {
  std::error_code error;
  return fs::status(path, error);
}

void check_replaceable(const fs::path& path, bool force) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  // Neither there nor missing: a name that is too long, a folder that may not be entered.
  if (status.type() == fs::file_type::none)
    throw Error(ErrorKind::output, fmt::format("cannot write: {}", error.message()), path.string());
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) throw Error(ErrorKind::output, "a folder has this name", path.string());
  if (!fs::is_regular_file(status))
    throw Error(ErrorKind::output, "this is not an ordinary file", path.string());
  if (!force) throw Error(ErrorKind::usage, "the file exists", path.string(), "--force replaces it");
}

std::string system_message(int code) { return std::generic_category().message(code); }

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

bool has_content(const fs::path& path, const std::vector<std::byte>& content) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) != content.size() || error)
    return false;
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return false;
  std::vector<std::byte> block(std::size_t{1} << 16);
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t got = std::fread(block.data(), 1, block.size(), file.get());
    if (got == 0 || got > content.size() - at) return false;
    if (!std::equal(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got),
                    content.begin() + static_cast<std::ptrdiff_t>(at))) {
      return false;
    }
    at += got;
  }
  return true;
}

/// Files under temporary names; what is not renamed in the end is removed.
class PendingFiles {
 public:
  PendingFiles() = default;
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;
  ~PendingFiles() {
    std::error_code ignored;
    for (const Pending& p : pending_) fs::remove(p.temporary, ignored);
    if (done_) return;
    for (const fs::path& path : created_) fs::remove(path, ignored);
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) fs::remove(*folder, ignored);
  }

  void add(const fs::path& path, const std::vector<std::byte>& content) {
    make_folders(folder_of(path));
    const File file = open_temporary(path);
    if (std::fwrite(content.data(), 1, content.size(), file.get()) != content.size() ||
        std::fflush(file.get()) != 0) {
      throw Error(ErrorKind::output, fmt::format("cannot write: {}", system_message(errno)), path.string());
    }
  }

  /// In the order of `add`; a reader that waits for the last sees all others.
  void rename_all() {
    while (!pending_.empty()) {
      const Pending& next = pending_.front();
      const bool existed = fs::exists(status_of(next.path));
      std::error_code error;
      if (existed) fs::permissions(next.temporary, status_of(next.path).permissions(), error);
      fs::rename(next.temporary, next.path, error);
      if (error) {
        throw Error(ErrorKind::output, fmt::format("cannot write: {}", error.message()), next.path.string());
      }
      if (!existed) created_.push_back(next.path);
      pending_.erase(pending_.begin());
    }
    done_ = true;
  }

 private:
  struct Pending {
    fs::path temporary, path;
  };

  void make_folders(const fs::path& folder) {
    if (fs::exists(status_of(folder))) {
      check_folder(folder);
      return;
    }
    make_folders(folder_of(folder));
    std::error_code error;
    fs::create_directory(folder, error);
    if (error) {
      throw Error(ErrorKind::output, fmt::format("cannot make the folder: {}", error.message()),
                  folder.string());
    }
    folders_.push_back(folder);
  }

  /// A name that nobody has: opening fails for one that exists, be it a link.
  File open_temporary(const fs::path& path) {
    constexpr int kAttempts = 1000;
    for (int i = 0; i < kAttempts; ++i) {
      const fs::path temporary = folder_of(path) / fmt::format(".{}.{}.part", path.filename().string(), i);
      File file(std::fopen(temporary.c_str(), "wbx"));
      if (file) {
        pending_.push_back({temporary, path});
        return file;
      }
      if (errno != EEXIST) break;
    }
    throw Error(ErrorKind::output, fmt::format("cannot write: {}", system_message(errno)), path.string());
  }

  std::vector<Pending> pending_;
  std::vector<fs::path> created_, folders_;
  bool done_ = false;
};

fs::path place_of(const fs::path& path, const OutputFile& file) {
  if (file.name.empty()) return path;
  const fs::path relative = fs::path(file.name).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..") {
    throw Error(ErrorKind::internal, fmt::format("'{}' would be written outside of the folder", file.name));
  }
  return folder_of(path) / relative;
}

std::vector<OutputFile> encode_model(const Model& model, const fs::path& path, const WriteOptions& options,
                                     Context& context) {
  const std::string extension = lower_extension(path), stem = path.stem().string();
  if (extension == ".obj") return write_obj(model, stem, context);
  if (extension == ".ply") return write_ply(model, stem, context);
  return write_gltf(model, extension == ".glb", stem, options, context).files;
}

}  // namespace

OptionList describe(WriteOptions& o) {
  OptionList list;
  const auto bits = [&](const char* name, const char* help, std::int64_t* value) {
    list.push_back({name, help, value, "bits", 1, 16});
  };
  list.push_back(
      {"quantize", "Store vertices as integers, which takes less than half of the bytes.", &o.quantize, {}});
  bits("position-bits",
       "Precision of quantised positions, of a mesh's largest extent; 14 hides the steps at any usual size.",
       &o.position_bits);
  bits("uv-bits",
       "Precision of quantised texture coordinates; 12 is a quarter of a pixel of a 1024-pixel texture.",
       &o.uv_bits);
  bits("normal-bits", "Precision of quantised normals and tangents; 8 is half a degree.", &o.normal_bits);
  bits("color-bits", "Precision of quantised vertex colours; 8 is what screens show.", &o.color_bits);
  list.push_back({"compression",
                  "Compress vertices and indices; off because not every viewer reads it.",
                  choice(o.compression, {"none", "meshopt"}),
                  {}});
  list.push_back({"force", "Replace existing files; off because what is replaced is lost.", &o.force, {}});
  return list;
}

void check_output(const fs::path& path, bool force) {
  check_extension(path, "models", {".glb", ".gltf", ".obj", ".ply"});
  check_place(path, force);
}

void check_output(const fs::path& path, const WriteOptions& options) {
  check_output(path, options.force);
  const std::string extension = lower_extension(path);
  if (extension == ".glb" || extension == ".gltf") return;
  const bool compressed = options.compression != GeometryCompression::none;
  if (!options.quantize && !compressed) return;
  throw Error(ErrorKind::usage,
              fmt::format("{} is for .glb and .gltf", options.quantize ? "--quantize" : "--compression"),
              path.string(), "leave it out, or name the output .glb");
}

void check_place(const fs::path& path, bool force) {
  check_folder(folder_of(path));
  check_replaceable(path, force);
}

void write_files(const fs::path& path, std::span<const OutputFile> files, bool force) {
  check_folder(folder_of(path));
  std::vector<const OutputFile*> needed;
  for (const OutputFile& file : files) {
    const fs::path place = place_of(path, file);
    // An image that is there already is no reason to stop, nor to write it again.
    if (!file.name.empty() && has_content(place, file.bytes)) continue;
    check_replaceable(place, force);
    needed.push_back(&file);
  }
  // The output itself comes last, so that it never stands there without what it refers to.
  std::stable_partition(needed.begin(), needed.end(),
                        [](const OutputFile* file) { return !file->name.empty(); });
  PendingFiles pending;
  for (const OutputFile* file : needed) pending.add(place_of(path, *file), file->bytes);
  pending.rename_all();
}

void write_text(const fs::path& path, std::string_view text, bool force) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(text));
  const OutputFile file{"", {bytes.begin(), bytes.end()}};
  write_files(path, {&file, 1}, force);
}

std::vector<fs::path> write_model(const Model& model, const fs::path& path, const WriteOptions& options,
                                  Context& context) {
  check_output(path, options);
  WriteOptions checked = options;
  check(describe(checked));
  const std::vector<OutputFile> files = encode_model(model, path, options, context);
  write_files(path, files, options.force);
  std::vector<fs::path> written{path};
  for (const OutputFile& file : files) {
    if (!file.name.empty()) written.push_back(place_of(path, file));
  }
  return written;
}

}  // namespace fovea
