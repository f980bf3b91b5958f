// Compiles and links a shader program (GLSL).
#pragma once

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"

namespace merlin::render::gl {

// Errors: kUnsupported, with the compiler's log.
Result<GLuint> linkProgram(const GlApi& gl, const char* vertex_source, const char* fragment_source);

}  // namespace merlin::render::gl
