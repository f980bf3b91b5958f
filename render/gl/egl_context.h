// Contexts of EGL, and the devices that it lists. Private to render/gl.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/gl/gl_context.h"

namespace merlin::render::gl {

struct EglDevice {
  void* handle = nullptr;  // EGLDeviceEXT
  bool software = false;   // Mesa's software renderer
  std::string node{};      // DRM render node, or the card's node; empty if unknown
  std::string card{};      // DRM node of the card's displays; empty if unknown
  std::string pci{};       // PCI address; empty if unknown
};
// Lists EGL's devices, at most 16, in EGL's order; empty if EGL cannot list devices.
std::vector<EglDevice> eglDevices();

// Creates a context on this device, current on the calling thread. Errors: kUnsupported.
Result<std::unique_ptr<GlContext>> makeEglContext(const EglDevice& device);
// Creates a context, current on the calling thread, on the EGL display that belongs to no device:
// Mesa then chooses a GPU or its software renderer. Errors: kUnsupported.
Result<std::unique_ptr<GlContext>> makeSurfacelessContext();

}  // namespace merlin::render::gl
