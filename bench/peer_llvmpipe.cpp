#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "fovea/base/error.h"
#include "fovea/base/srgb.h"
#include "render_peers.h"

namespace fovea::bench {
namespace {

constexpr int kSamples = 4;

constexpr const char* kVertexShader = R"(#version 300 es
uniform mat4 clip_from_world;
uniform vec3 u_row, v_row;
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
out vec2 at;
void main() {
  at = vec2(dot(u_row, vec3(uv, 1)), dot(v_row, vec3(uv, 1)));
  gl_Position = clip_from_world * vec4(position, 1);
}
)";
constexpr const char* kFragmentShader = R"(#version 300 es
precision highp float;
uniform vec4 factor;
uniform float cutoff;
uniform bool is_opaque;
uniform sampler2D map;
in vec2 at;
out vec4 color;
void main() {
  color = factor * texture(map, at);
  if (color.a < cutoff) discard;
  if (is_opaque) color.a = 1.0;
}
)";

[[noreturn]] void give_up(const std::string& what) { throw Error(ErrorKind::internal, "llvmpipe: " + what); }

/// A context without a window on the software driver. One per process, never taken down.
void make_context(int threads) {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  const EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
    give_up("no display without a window");
  eglBindAPI(EGL_OPENGL_ES_API);
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) give_up("no OpenGL ES 3 context");
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
    give_up("the context cannot be used");
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (name == nullptr || std::strstr(name, "llvmpipe") == nullptr)
    give_up(fmt::format("the driver is {}", name == nullptr ? "unknown" : name));
}

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_FALSE) give_up("a shader does not compile");
  return shader;
}

GLuint make_program() {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, kFragmentShader));
  glLinkProgram(program);
  GLint ok = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_FALSE) give_up("the shaders do not link");
  glUseProgram(program);
  return program;
}

GLuint make_target(int size, int samples) {
  GLuint framebuffer = 0, color = 0, depth = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenRenderbuffers(1, &color);
  glBindRenderbuffer(GL_RENDERBUFFER, color);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_SRGB8_ALPHA8, size, size);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glGenRenderbuffers(1, &depth);
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, size, size);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) give_up("no picture to draw into");
  return framebuffer;
}

GLuint upload(const MipMap& map) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const Rgba texel = map.texel(0, x, y);
      pixels.insert(pixels.end(), {to_display(texel.r), to_display(texel.g), to_display(texel.b),
                                   static_cast<std::uint8_t>(texel.a * 255 + 0.5f)});
    }
  }
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, map.width(), map.height(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
               pixels.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  return texture;
}

GLuint upload_white() {
  const std::uint8_t white[4] = {255, 255, 255, 255};
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, white);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  return texture;
}

/// The triangles of one material of a mesh.
struct Batch {
  const SceneMaterial* material = nullptr;
  bool mirrored = false;
  GLuint vertex_array = 0, texture = 0;
  GLsizei count = 0;
};

struct GlVertex {
  Vec3f position;
  Vec2f uv;
};

class GlScene {
 public:
  GlScene(const RenderScene& scene, int size, int threads) : scene_(scene), size_(size) {
    make_context(threads);
    program_ = make_program();
    many_ = make_target(size, kSamples);
    one_ = make_target(size, 0);
    white_ = upload_white();
    textures_.resize(scene.images.size(), 0);
    for (const SceneMesh& mesh : scene.meshes) {
      for (std::uint32_t part = 0; part < mesh.part_material.size(); ++part) add(mesh, part);
    }
    std::stable_partition(batches_.begin(), batches_.end(),
                          [](const Batch& batch) { return batch.material->alpha_mode != AlphaMode::blend; });
    glEnable(GL_DEPTH_TEST);
    glViewport(0, 0, size, size);
  }

  Image8 draw(const View& view) const {
    glBindFramebuffer(GL_FRAMEBUFFER, many_);
    const float grey = to_light(128);
    glDepthMask(GL_TRUE);
    glClearColor(grey, grey, grey, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const std::array<float, 16> clip = clip_from_world(view);
    glUniformMatrix4fv(glGetUniformLocation(program_, "clip_from_world"), 1, GL_FALSE, clip.data());
    for (const Batch& batch : batches_) draw(batch);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, many_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, one_);
    glBlitFramebuffer(0, 0, size_, size_, 0, 0, size_, size_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, one_);
    Image8 image(size_, size_, 4, ColorEncoding::srgb);
    glReadPixels(0, 0, size_, size_, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    if (glGetError() != GL_NO_ERROR) give_up("drawing failed");
    return image;
  }

 private:
  void add(const SceneMesh& mesh, std::uint32_t part) {
    Batch batch;
    batch.material = &scene_.materials[mesh.part_material[part]];
    batch.mirrored = mesh.surface.mirrored;
    batch.texture = white_;
    const AttributeLayer* uv = nullptr;
    if (const auto& texture = batch.material->base_color_texture) {
      if (static_cast<std::size_t>(texture->uv_set) < mesh.uv.size())
        uv = mesh.uv[static_cast<std::size_t>(texture->uv_set)];
      GLuint& known = textures_[static_cast<std::size_t>(texture->image)];
      if (known == 0) known = upload(*scene_.images[static_cast<std::size_t>(texture->image)].map);
      if (uv != nullptr) batch.texture = known;
    }
    std::vector<GlVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    const auto& triangles = mesh.mesh->triangles;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      if (mesh.mesh->face_part[f] != part) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId v = triangles[f][k];
        const ValueId value = uv != nullptr ? uv->corner_value[3 * f + k] : ValueId{};
        const auto [at, is_new] =
            known.try_emplace({v.value, value.value}, static_cast<std::uint32_t>(vertices.size()));
        if (is_new) {
          const float* numbers = value.valid() ? uv->value(value) : nullptr;
          vertices.push_back({mesh.surface.positions[v.index()],
                              numbers != nullptr ? Vec2f{numbers[0], numbers[1]} : Vec2f{}});
        }
        indices.push_back(at->second);
      }
    }
    if (indices.empty()) return;
    batch.count = static_cast<GLsizei>(indices.size());
    glGenVertexArrays(1, &batch.vertex_array);
    glBindVertexArray(batch.vertex_array);
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(GlVertex)),
                 vertices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof indices[0]),
                 indices.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(GlVertex), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(GlVertex),
                          reinterpret_cast<const void*>(sizeof(Vec3f)));
    batches_.push_back(batch);
  }

  void draw(const Batch& batch) const {
    const SceneMaterial& material = *batch.material;
    const auto toggle = [](GLenum what, bool on) { (on ? glEnable : glDisable)(what); };
    const bool blended = material.alpha_mode == AlphaMode::blend;
    toggle(GL_CULL_FACE, !material.double_sided);
    glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
    toggle(GL_BLEND, blended);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(blended ? GL_FALSE : GL_TRUE);
    const auto at = [&](const char* name) { return glGetUniformLocation(program_, name); };
    const Rgba& c = material.base_color;
    glUniform4f(at("factor"), c.r, c.g, c.b, c.a);
    glUniform1f(at("cutoff"), material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : -1.0f);
    glUniform1i(at("is_opaque"), blended ? 0 : 1);
    const SceneTexture texture = material.base_color_texture.value_or(SceneTexture{});
    const UvMatrixf& m = texture.matrix;
    glUniform3f(at("u_row"), m.u.x, m.v.x, m.offset.x);
    glUniform3f(at("v_row"), m.u.y, m.v.y, m.offset.y);
    glBindTexture(GL_TEXTURE_2D, batch.texture);
    const auto wrap = [](Wrap w) {
      return w == Wrap::repeat ? GL_REPEAT : w == Wrap::mirror ? GL_MIRRORED_REPEAT : GL_CLAMP_TO_EDGE;
    };
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap(texture.sampler.wrap_u));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap(texture.sampler.wrap_v));
    glBindVertexArray(batch.vertex_array);
    glDrawElements(GL_TRIANGLES, batch.count, GL_UNSIGNED_INT, nullptr);
  }

  /// In the order of GL: columns.
  std::array<float, 16> clip_from_world(const View& view) const {
    const double middle = view.to_eye(scene_.sphere.center).z, radius = 1.01 * scene_.sphere.radius;
    const double near = std::max(middle - radius, 1e-3 * middle), far = middle + radius;
    const double scale = 1 / view.half_height, depth = (far + near) / (far - near),
                 shift = -2 * far * near / (far - near);
    const Vec3d x = view.right * scale, y = view.up * scale, z = view.back * -1.0;
    const double ox = -dot(x, view.eye), oy = -dot(y, view.eye), oz = -dot(z, view.eye);
    const auto f = [](double v) { return static_cast<float>(v); };
    return {f(x.x), f(y.x), f(depth * z.x), f(z.x), f(x.y), f(y.y), f(depth * z.y),        f(z.y),
            f(x.z), f(y.z), f(depth * z.z), f(z.z), f(ox),  f(oy),  f(depth * oz + shift), f(oz)};
  }

  const RenderScene& scene_;
  int size_;
  GLuint program_ = 0, many_ = 0, one_ = 0, white_ = 0;
  std::vector<GLuint> textures_;  // [#images], 0 until it is used
  std::vector<Batch> batches_;
};

/// GL's rows go up, and pictures of a window have no alpha.
Image8 upright(const Image8& image) {
  Image8 out(image.width, image.height, 3, ColorEncoding::srgb);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, image.height - 1 - y), 3, out.at(x, y));
  }
  return out;
}

}  // namespace

std::function<std::vector<Image8>()> llvmpipe_peer(const ViewJob& job) {
  auto gl = std::make_shared<GlScene>(*job.scene, job.size, job.threads);
  gl->draw(job.views.front());  // compiles the shaders
  return [gl, job] {
    std::vector<Image8> pictures;
    for (const View& view : job.views) pictures.push_back(upright(gl->draw(view)));
    return pictures;
  };
}

}  // namespace fovea::bench
