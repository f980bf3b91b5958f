#include "render/gl/shader.h"

#include <string>

namespace merlin::render::gl {
namespace {

constexpr GLsizei kLogSize = 2048;

Result<GLuint> compile(const GlApi& gl, GLenum kind, const char* source) {
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::string log(kLogSize, '\0');
  GLsizei length = 0;
  gl.GetShaderInfoLog(shader, kLogSize, &length, log.data());
  gl.DeleteShader(shader);
  log.resize(static_cast<std::size_t>(length));
  return Error{Errc::kUnsupported, "a shader does not compile: " + log};
}

}  // namespace

Result<GLuint> linkProgram(const GlApi& gl, const char* vertex_source,
                           const char* fragment_source) {
  const auto vertex = compile(gl, GL_VERTEX_SHADER, vertex_source);
  if (!vertex) return vertex.error();
  const auto fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_source);
  if (!fragment) {
    gl.DeleteShader(*vertex);
    return fragment.error();
  }
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {*vertex, *fragment}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // deleted together with the program
  }
  gl.LinkProgram(program);
  GLint good = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &good);
  if (good) return program;
  std::string log(kLogSize, '\0');
  GLsizei length = 0;
  gl.GetProgramInfoLog(program, kLogSize, &length, log.data());
  gl.DeleteProgram(program);
  log.resize(static_cast<std::size_t>(length));
  return Error{Errc::kUnsupported, "a program does not link: " + log};
}

}  // namespace merlin::render::gl
