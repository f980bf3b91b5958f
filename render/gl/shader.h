// Compiles and links a shader program (GLSL).
#pragma once

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"

namespace merlin::render::gl {

// Returns the OpenGL name of the linked program, which the caller deletes. Errors: kUnsupported,
// with the log of the compiler or linker.
Result<GLuint> linkProgram(const GlApi& gl, const char* vertex_source, const char* fragment_source);

}  // namespace merlin::render::gl
