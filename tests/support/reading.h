#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/base/context.h"
#include "fovea/base/error.h"
#include "fovea/model/tri_mesh.h"

namespace fovea::test {

inline std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
inline std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// An empty folder of its own that goes away with its contents.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fovea-test-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  /// Writes a file, its folders too, and returns its path.
  std::filesystem::path add(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// How often a diagnostic was reported.
inline std::uint64_t told(const Context& context, const std::string& code) {
  for (const Diagnostic& d : context.diagnostics()) {
    if (d.code == code) return d.count;
  }
  return 0;
}

/// The error that a call throws; none if it throws none.
template <class Call>
std::optional<Error> error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  return {};
}

/// Expects an error of that kind whose place contains `place` and whose message contains `message`.
template <class Call>
void expect_error(const Call& call, ErrorKind kind, const std::string& place,
                  const std::string& message = {}) {
  const auto error = error_of(call);
  ASSERT_TRUE(error) << "no error";
  EXPECT_EQ(error->kind(), kind) << error->what();
  EXPECT_NE(error->place().find(place), std::string::npos) << error->what();
  EXPECT_NE(error->message().find(message), std::string::npos) << error->what();
}

/// The folder of the corpus, if the environment names one.
inline std::optional<std::filesystem::path> corpus_folder() {
  const char* folder = std::getenv("FOVEA_DATA");
  if (folder == nullptr || *folder == '\0') return {};
  return folder;
}

/// A file of the corpus, if there is one.
inline std::optional<std::filesystem::path> corpus_file(const std::string& name) {
  const auto folder = corpus_folder();
  if (!folder) return {};
  return *folder / name;
}

/// The smallest PNG: one white pixel, RGB.
std::string tiny_png();

}  // namespace fovea::test
