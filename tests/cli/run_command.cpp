#include "run_command.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "fovea/base/context.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/write.h"
#include "support/meshes.h"

namespace fovea::test {

namespace fs = std::filesystem;

Folder::Folder() {
  std::string pattern = (fs::temp_directory_path() / "fovea-cli-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(path_ / name, std::ios::binary) << bytes;
  return (path_ / name).string();
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Running::Running(const std::vector<std::string>& arguments, const std::string& stdout_path,
                 const std::string& limit)
    : out_(stdout_path.empty() ? folder_ / "out" : ""), err_(folder_ / "err") {
  std::vector<std::string> words{FOVEA_PROGRAM};
  if (!limit.empty())
    words = {"/bin/sh", "-c", "ulimit -c 0; ulimit " + limit + "; exec \"$0\" \"$@\"", FOVEA_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, (out_.empty() ? stdout_path : out_).c_str(),
                                   kWrite, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), kWrite, 0600);
  const int failed = posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " FOVEA_PROGRAM);
}

Running::~Running() {
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

bool Running::wait_for_talk(const std::string& text) const {
  for (int i = 0; i < 1000; ++i) {
    const std::string talk = read_text(err_);
    if (!talk.empty() && talk.find(text) != talk.npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

void Running::send(int signal) const { kill(process_, signal); }

Outcome Running::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return {code, out_.empty() ? "" : read_text(out_), read_text(err_)};
}

Outcome fovea(const std::vector<std::string>& arguments, const std::string& stdout_path) {
  return Running(arguments, stdout_path).wait();
}

Outcome fovea_within(const std::string& limit, const std::vector<std::string>& arguments) {
  return Running(arguments, {}, limit).wait();
}

std::string square_obj() { return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"; }

std::string write_grid(const Folder& folder, const std::string& name, int quads) {
  Model model = model_of(wavy_grid(quads, quads, 0.1));
  EncodedImage image;
  image.name = "dots";
  image.mime_type = "image/png";
  image.bytes = encode_png(Image8(16, 8, 3, ColorEncoding::srgb));
  model.images.push_back(image);
  model.textures.push_back({0, -1, "", ""});
  model.materials.assign(1, Material{});
  model.materials[0].base_color = TextureRef{0, 0, {}};
  for (Part& part : model.meshes[0].surface.parts) part.material = 0;
  Context context;
  write_model(model, folder / name, {}, context);
  return folder / name;
}

}  // namespace fovea::test
