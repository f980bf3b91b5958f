// RendererInfo: which library, driver and device draw in a context.
#pragma once

#include <string>
#include <string_view>

namespace merlin::render::gl {

struct RendererInfo {
  std::string library{};  // "EGL" or "OSMesa"
  std::string name{};     // GL_RENDERER: "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string vendor{};   // GL_VENDOR
  std::string driver{};   // GL_VERSION: "4.5 (Core Profile) Mesa 22.3.6"
  std::string node{};     // DRM node, "/dev/dri/renderD128"; empty if unknown
  std::string pci{};      // "0000:01:00.0"; empty if unknown
  bool software = true;   // drawn by the CPU
};

// Returns true if a renderer of this name (GL_RENDERER) draws on the CPU.
bool isSoftwareRenderer(std::string_view name);

}  // namespace merlin::render::gl
