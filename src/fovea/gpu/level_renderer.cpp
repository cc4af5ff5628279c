#include "fovea/gpu/level_renderer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fovea/base/error.h"
#include "fovea/gpu/gl_objects.h"
#include "fovea/gpu/gpu_context.h"

namespace fovea {

namespace {

constexpr const char* kVertexShader = R"(#version 430
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 clip_from_world, world_from_mesh;
out vec3 at, n;
void main() {
  vec4 p = world_from_mesh * vec4(position, 1);
  at = p.xyz;
  n = mat3(world_from_mesh) * normal;
  gl_Position = clip_from_world * p;
}
)";

constexpr const char* kFragmentShader = R"(#version 430
in vec3 at, n;
uniform vec3 eye;
uniform bool has_normals;
out vec4 color;
void main() {
  vec3 facet = cross(dFdx(at), dFdy(at));
  vec3 shown = has_normals ? n : facet;
  float light = abs(dot(normalize(shown), normalize(eye - at)));
  color = vec4(vec3(0.1 + 0.8 * light), 1);
}
)";

/// World to clip space, column by column.
std::array<float, 16> clip_from_world(const LevelCamera& camera, double near, double far) {
  const View& view = camera.view;
  const double half_width = view.half_height * camera.width / camera.height;
  std::array<float, 16> m{};
  const auto row = [&](std::size_t i, Vec3d direction, double scale, double add) {
    const Vec3d n = direction * scale;
    const std::array<double, 4> values{n.x, n.y, n.z, add - dot(n, view.eye)};
    for (std::size_t k = 0; k < 4; ++k) m[4 * k + i] = static_cast<float>(values[k]);
  };
  row(0, view.right, 1 / half_width, 0);
  row(1, view.up, 1 / view.half_height, 0);
  if (view.perspective) {
    row(2, -view.back, (far + near) / (far - near), -2 * far * near / (far - near));
    row(3, -view.back, 1, 0);
  } else {
    row(2, -view.back, 2 / (far - near), -(far + near) / (far - near));
    row(3, {}, 0, 1);
  }
  return m;
}

std::array<float, 16> columns(const Mat4& matrix) {
  std::array<float, 16> m{};
  std::ranges::transform(matrix.m, m.begin(), [](double x) { return static_cast<float>(x); });
  return m;
}

}  // namespace

struct LevelRenderer::Card {
  struct MeshBuffers {
    GLuint array = 0;
    GlBuffer positions, normals;
    bool has_normals = false;
    std::vector<std::array<float, 16>> instances;
  };

  ~Card() {
    for (const MeshBuffers& mesh : meshes) glDeleteVertexArrays(1, &mesh.array);
    glDeleteFramebuffers(1, &frame);
    glDeleteRenderbuffers(1, &color);
    glDeleteRenderbuffers(1, &depth);
  }

  GlProgram program{{GL_VERTEX_SHADER, kVertexShader}, {GL_FRAGMENT_SHADER, kFragmentShader}};
  std::vector<MeshBuffers> meshes;
  GlBuffer full, uploaded;
  GLuint frame = 0, color = 0, depth = 0;
  Sphere sphere;  // around all
};

LevelRenderer::LevelRenderer(const Model& original, const VertexHierarchy& hierarchy, int width, int height)
    : hierarchy_(hierarchy), width_(width), height_(height) {
  need_gpu_context();
  card_ = std::make_unique<Card>();
  const auto instances = mesh_instances(original);
  for (std::size_t m = 0; m < hierarchy.vertices.size(); ++m) {
    const LevelVertices& vertices = hierarchy.vertices[m];
    Card::MeshBuffers& mesh = card_->meshes.emplace_back();
    glGenVertexArrays(1, &mesh.array);
    glBindVertexArray(mesh.array);
    const auto add = [](GLuint location, const GlBuffer& buffer) {
      glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
      glEnableVertexAttribArray(location);
      glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    };
    mesh.positions = GlBuffer(vertices.positions);
    add(0, mesh.positions);
    for (const AttributeLayer& layer : vertices.layers) {
      if (layer.semantic != Semantic::normal) continue;
      mesh.normals = GlBuffer(layer.values);
      mesh.has_normals = true;
      add(1, mesh.normals);
    }
    for (const Mat4& instance : instances[m]) mesh.instances.push_back(columns(instance));
  }
  std::vector<std::uint32_t> all;
  for (const auto& corners : hierarchy.corners) {
    for (const std::uint32_t node : corners) all.push_back(hierarchy.vertex[node]);
  }
  card_->full = GlBuffer(all);
  card_->uploaded = GlBuffer(12 * hierarchy.face_count());
  const Box box = bounds(original);
  if (!box.empty()) card_->sphere = {(box.low + box.high) * 0.5, 0.5 * box.diagonal()};

  glGenFramebuffers(1, &card_->frame);
  glBindFramebuffer(GL_FRAMEBUFFER, card_->frame);
  const auto attach = [&](GLuint& buffer, GLenum format, GLenum where) {
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
  };
  attach(card_->color, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  attach(card_->depth, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error(ErrorKind::unsupported, "the driver has no room for a picture of this size", "gpu");
}

LevelRenderer::~LevelRenderer() = default;

void LevelRenderer::begin(const LevelCamera& camera) const {
  glBindFramebuffer(GL_FRAMEBUFFER, card_->frame);
  glViewport(0, 0, width_, height_);
  glEnable(GL_DEPTH_TEST);
  glClearColor(0.5f, 0.5f, 0.5f, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  card_->program.use();
  const Sphere& sphere = card_->sphere;
  const double middle = camera.view.to_eye(sphere.center).z;
  const double far = std::max(middle + sphere.radius, 1e-6 * sphere.radius) * 1.01 + 1e-30;
  double near = std::max({middle - sphere.radius, camera.view.near, 1e-3 * far});
  if (!camera.view.perspective) near = middle - 1.01 * sphere.radius;
  const std::array<float, 16> clip = clip_from_world(camera, near, far);
  glUniformMatrix4fv(card_->program.uniform("clip_from_world"), 1, GL_FALSE, clip.data());
  const Vec3f eye(camera.view.eye);
  glUniform3f(card_->program.uniform("eye"), eye.x, eye.y, eye.z);
}

/// Calls `draw_part(p)` for each instance that shows part p, with everything else bound.
template <class DrawPart>
void LevelRenderer::draw_parts(DrawPart&& draw_part) const {
  const GLint world = card_->program.uniform("world_from_mesh");
  const GLint has_normals = card_->program.uniform("has_normals");
  for (std::size_t p = 0; p < hierarchy_.parts.size(); ++p) {
    const Card::MeshBuffers& mesh = card_->meshes[hierarchy_.parts[p].mesh];
    glBindVertexArray(mesh.array);
    glUniform1i(has_normals, mesh.has_normals);
    for (const auto& instance : mesh.instances) {
      glUniformMatrix4fv(world, 1, GL_FALSE, instance.data());
      draw_part(p);
    }
  }
}

namespace {

void draw_indices(GLuint buffer, std::size_t first_face, std::size_t triangles) {
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(12 * first_face));
}

}  // namespace

void LevelRenderer::draw(const LevelCamera& camera, const LevelIndices& level) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, card_->uploaded.name());
  for (std::size_t p = 0; p < hierarchy_.parts.size(); ++p) {
    const std::span<const std::uint32_t> indices = level.of_part(hierarchy_, p);
    glBufferSubData(GL_COPY_WRITE_BUFFER,
                    static_cast<GLintptr>(12 * std::size_t{hierarchy_.parts[p].first_face}),
                    static_cast<GLsizeiptr>(indices.size_bytes()), indices.data());
  }
  begin(camera);
  draw_parts([&](std::size_t p) {
    draw_indices(card_->uploaded.name(), hierarchy_.parts[p].first_face, level.triangles[p]);
  });
}

void LevelRenderer::draw(const LevelCamera& camera, const GpuContraction& level) {
  begin(camera);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, level.draw_buffer());
  constexpr std::size_t kCommand = 20;  // bytes
  draw_parts([&](std::size_t p) {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, level.index_buffer());
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(kCommand * p));
  });
}

void LevelRenderer::draw(const LevelCamera& camera) {
  begin(camera);
  draw_parts([&](std::size_t p) {
    const LevelPart& part = hierarchy_.parts[p];
    draw_indices(card_->full.name(), part.first_face, part.end_face - part.first_face);
  });
}

void LevelRenderer::finish() const { glFinish(); }

Image8 LevelRenderer::picture() const {
  std::vector<std::uint8_t> pixels(4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_FRAMEBUFFER, card_->frame);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  Image8 image(width_, height_, 3, ColorEncoding::srgb);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* from =
        pixels.data() + 4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_ - 1 - y);
    for (int x = 0; x < width_; ++x) std::copy_n(from + 4 * x, 3, image.at(x, y));
  }
  return image;
}

}  // namespace fovea
