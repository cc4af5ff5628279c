#include "fovea/io/off_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "fovea/io/indexed_mesh.h"
#include "fovea/io/text_scan.h"
#include "fovea/io/triangulate.h"

namespace fovea {

namespace {

/// After empty lines and comments.
std::string_view first_word(std::span<const std::byte> bytes) {
  TextScanner scan(bytes.first(std::min<std::size_t>(bytes.size(), 4096)));
  while (!scan.at_end() && scan.line_done()) scan.next_line();
  return scan.word();
}

class OffReader {
 public:
  OffReader(std::span<const std::byte> bytes, const std::string& place, const ReadOptions& options,
            Context& context)
      : scan_(bytes), size_(bytes.size()), place_(place), options_(options), context_(context) {}

  IndexedMesh run() {
    read_header();
    for (std::uint64_t v = 0; v < vertices_; ++v) read_vertex();
    add_attributes();
    for (std::uint64_t f = 0; f < faces_; ++f) read_face();
    return std::move(mesh_);
  }

 private:
  void read_header();
  void read_vertex();
  void add_attributes();
  void read_face();
  /// To the next line that has something on it.
  void next_content() {
    while (scan_.line_done()) {
      if (scan_.at_end()) refuse("the data ends early");
      scan_.next_line();
    }
  }
  template <class T>
  T number() {
    T value{};
    if (!scan_.number(value)) refuse("this is not a number");
    return value;
  }
  [[noreturn]] void refuse(const std::string& message) const {
    throw Error(ErrorKind::format, message, fmt::format("{}: line {}", place_, scan_.line()));
  }

  TextScanner scan_;
  std::size_t size_;
  const std::string& place_;
  const ReadOptions& options_;
  Context& context_;
  IndexedMesh mesh_;
  bool has_normals_ = false, has_colors_ = false;
  std::vector<float> normals_, colors_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  Triangulator triangulator_;
  std::vector<std::uint32_t> indices_;
  std::vector<Vec3f> polygon_;
};

void OffReader::read_header() {
  next_content();
  const std::string_view word = scan_.word();
  has_normals_ = word.find('N') != word.npos;
  has_colors_ = word.find('C') != word.npos;
  TextScanner ahead = scan_;
  if (ahead.word() == "BINARY") throw Error(ErrorKind::unsupported, "binary OFF is not supported", place_);
  next_content();
  vertices_ = number<std::uint64_t>();
  faces_ = number<std::uint64_t>();
  scan_.next_line();
  // "0 0 0" and "3 0 1 2", each with its line end, are the least that a row can be.
  const std::uint64_t left = size_ - scan_.offset() + 1;
  if (vertices_ > left / 6 || faces_ > left / 2) {
    refuse(fmt::format("{} vertices and {} faces do not fit the {} bytes that follow", vertices_, faces_,
                       left - 1));
  }
  check_element_count(vertices_, "vertices", options_, place_);
  check_element_count(faces_, "faces", options_, place_);
}

void OffReader::read_vertex() {
  next_content();
  const float x = number<float>(), y = number<float>(), z = number<float>();
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) refuse("a vertex is not finite");
  mesh_.positions.emplace_back(x, y, z);
  for (int k = 0; has_normals_ && k < 3; ++k) normals_.push_back(number<float>());
  for (int k = 0; has_colors_ && k < 3; ++k) {
    const float c = number<float>();
    colors_.push_back(std::isfinite(c) ? c : 0);
  }
  scan_.next_line();
}

void OffReader::add_attributes() {
  const auto add = [&](Semantic semantic, std::vector<float>&& values) {
    VertexArray& array = mesh_.attributes.emplace_back();
    array.semantic = semantic;
    array.width = 3;
    array.values = std::move(values);
  };
  if (has_normals_) add(Semantic::normal, std::move(normals_));
  if (!has_colors_ || colors_.empty()) return;
  const float scale = *std::max_element(colors_.begin(), colors_.end()) > 1 ? 1.0f / 255 : 1.0f;
  for (float& c : colors_) c = srgb_to_linear(c * scale);
  add(Semantic::color, std::move(colors_));
}

void OffReader::read_face() {
  next_content();
  const auto count = number<std::uint64_t>();
  if (count > (size_ - scan_.offset()) / 2 + 1) refuse("a face has more corners than the file has numbers");
  indices_.clear();
  polygon_.clear();
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto index = number<std::int64_t>();
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
      refuse(fmt::format("vertex index {} but there are {} vertices", index, vertices_));
    }
    indices_.push_back(static_cast<std::uint32_t>(index));
    polygon_.push_back(mesh_.positions[indices_.back()]);
  }
  scan_.next_line();
  if (count < 3) {
    context_.report("small-faces", "faces with fewer than three corners were dropped", place_);
    return;
  }
  if (mesh_.groups.empty()) mesh_.groups.emplace_back();
  for (const auto& triangle : triangulator_.run(polygon_)) {
    for (const std::uint32_t k : triangle) mesh_.groups[0].positions.push_back(indices_[k]);
  }
}

}  // namespace

bool is_off(std::span<const std::byte> bytes) {
  const std::string_view word = first_word(bytes);
  return word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF" || word == "NCOFF" ||
         word == "STOFF" || word == "STCOFF" || word == "STNOFF" || word == "STCNOFF";
}

Model read_off(std::span<const std::byte> bytes, const std::string& place, const ReadOptions& options,
               Context& context) {
  IndexedMesh mesh = OffReader(bytes, place, options, context).run();
  return model_of(weld(std::move(mesh), options, context, place),
                  std::filesystem::path(place).stem().string());
}

}  // namespace fovea
