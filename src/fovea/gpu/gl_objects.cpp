#include "fovea/gpu/gl_objects.h"

#include <algorithm>

#include "fovea/base/error.h"

namespace fovea {

namespace {

[[noreturn]] void refuse(const std::string& log) { throw Error(ErrorKind::internal, log, "shader"); }

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::string log(4096, '\0');
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  refuse(log.c_str());
}

}  // namespace

GlBuffer::GlBuffer(std::size_t bytes, const void* data) {
  glGenBuffers(1, &name_);
  glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
  // Empty ones cannot be bound.
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 4)),
               bytes > 0 ? data : nullptr, GL_DYNAMIC_DRAW);
}

GlBuffer::~GlBuffer() {
  if (name_ != 0) glDeleteBuffers(1, &name_);
}

void GlBuffer::set(std::span<const std::byte> bytes) const {
  glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
  glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void GlBuffer::get(std::span<std::byte> bytes) const {
  glBindBuffer(GL_COPY_READ_BUFFER, name_);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

GlProgram::GlProgram(std::initializer_list<Stage> stages) : name_(glCreateProgram()) {
  for (const Stage& stage : stages) {
    const GLuint shader = compile(stage.kind, stage.source);
    glAttachShader(name_, shader);
    glDeleteShader(shader);  // once the program goes
  }
  glLinkProgram(name_);
  GLint ok = GL_FALSE;
  glGetProgramiv(name_, GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return;
  std::string log(4096, '\0');
  glGetProgramInfoLog(name_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteProgram(name_);
  refuse(log.c_str());
}

GlProgram::~GlProgram() { glDeleteProgram(name_); }

}  // namespace fovea
