// The context of OSMesa. Private to render/gl.
#pragma once

#include <memory>

#include "daemon/base/result.h"
#include "render/gl/gl_context.h"

namespace merlin::render::gl {

// Current on the calling thread. Errors: kUnsupported.
Result<std::unique_ptr<GlContext>> makeOsmesaContext();

}  // namespace merlin::render::gl
