#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Private to gpu.

namespace fovea {

/// Memory of the card.
class GlBuffer {
 public:
  GlBuffer() = default;
  explicit GlBuffer(std::size_t bytes, const void* data = nullptr);
  template <class T>
  explicit GlBuffer(const std::vector<T>& data) : GlBuffer(data.size() * sizeof(T), data.data()) {}
  ~GlBuffer();
  GlBuffer(GlBuffer&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlBuffer& operator=(GlBuffer&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }

  GLuint name() const { return name_; }
  void set(std::span<const std::byte> bytes) const;
  void get(std::span<std::byte> bytes) const;
  /// As the storage buffer of that binding of shaders.
  void bind(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name_); }

 private:
  GLuint name_ = 0;
};

/// Shaders, linked.
class GlProgram {
 public:
  struct Stage {
    GLenum kind;
    const char* source;
  };
  /// Throws Error(internal) with what the driver says if it does not compile them.
  explicit GlProgram(std::initializer_list<Stage> stages);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const { glUseProgram(name_); }
  GLint uniform(const char* name) const { return glGetUniformLocation(name_, name); }

 private:
  GLuint name_ = 0;
};

}  // namespace fovea
