// The context of OSMesa. Private to render/gl.
#pragma once

#include <memory>

#include "daemon/base/result.h"
#include "render/gl/gl_context.h"

namespace merlin::render::gl {

// Creates OSMesa's context, current on the calling thread. Errors: kUnsupported (the library is
// missing or too old).
Result<std::unique_ptr<GlContext>> makeOsmesaContext();

}  // namespace merlin::render::gl
