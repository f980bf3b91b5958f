// Resolves the OpenGL functions of a context. Private to render/gl.
#pragma once

#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "daemon/base/result.h"
#include "render/gl/gl_api.h"
#include "render/gl/renderer_info.h"

namespace merlin::render::gl {

// Resolves all functions of GlApi except GetGraphicsResetStatus. `resolve(name)` returns a function
// of any type, or null. Errors: kUnsupported, with the first function that is missing.
template <typename Resolve>
Result<GlApi> loadApi(Resolve resolve) {
  GlApi api;
  std::string missing;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(resolve(name));
    if (!function && missing.empty()) missing = name;
  };
#define MERLIN_GL_LOAD(type, name) load(api.name, "gl" #name);
  MERLIN_GL_FUNCTIONS(MERLIN_GL_LOAD)
#undef MERLIN_GL_LOAD
  if (missing.empty()) return api;
  return Error{Errc::kUnsupported, fmt::format("this OpenGL lacks the function {}", missing)};
}

// Returns the renderer of the current context.
inline RendererInfo rendererOf(const GlApi& gl, const char* library) {
  const auto text = [&](GLenum name) {
    const auto* const string = reinterpret_cast<const char*>(gl.GetString(name));
    return std::string(string ? string : "");
  };
  RendererInfo info{.library = library,
                    .name = text(GL_RENDERER),
                    .vendor = text(GL_VENDOR),
                    .driver = text(GL_VERSION)};
  info.software = isSoftwareRenderer(info.name);
  return info;
}

}  // namespace merlin::render::gl
