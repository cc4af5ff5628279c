#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fovea::test {

/// What a finished command left: exit code (or 1000 + signal), stdout, stderr.
struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
  /// stdout as the one JSON object that it must be; a failed parse gives a discarded value.
  nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// An empty folder that goes with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file in it and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  /// Names of all that is in it, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::string& path);

/// The program, started with arguments and not waited for.
class Running {
 public:
  explicit Running(const std::vector<std::string>& arguments, const std::string& stdout_path = {},
                   const std::string& limit = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Waits until something is on stderr, or that text, for ten seconds at most.
  bool wait_for_talk(const std::string& text = {}) const;
  void send(int signal) const;
  Outcome wait();

 private:
  Folder folder_;
  std::string out_, err_;  // Empty if stdout goes elsewhere.
  pid_t process_ = -1;
};

/// Runs the program to its end. `stdout_path` takes stdout instead of `Outcome::out`.
Outcome fovea(const std::vector<std::string>& arguments, const std::string& stdout_path = {});

/// The same within a limit of the shell's: `limit` is what `ulimit` is told, such as "-f 1".
Outcome fovea_within(const std::string& limit, const std::vector<std::string>& arguments);

/// A model of two triangles (a unit square) without textures, as OBJ text.
std::string square_obj();

/// Writes a wavy square of quads × quads × 2 triangles with normals, texture coordinates and a texture
/// of 16 × 8 pixels, which is quicker than a sample. Returns its path.
std::string write_grid(const Folder& folder, const std::string& name, int quads = 24);

}  // namespace fovea::test
