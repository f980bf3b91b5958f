#include "render/gl/egl_context.h"

#include <cstring>
#include <filesystem>
#include <iterator>
#include <utility>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "render/gl/egl_import.h"
#include "render/gl/load_api.h"

namespace merlin::render::gl {
namespace {

#ifndef EGL_DRM_RENDER_NODE_FILE_EXT
constexpr EGLint EGL_DRM_RENDER_NODE_FILE_EXT = 0x3377;
#endif

Error eglError(const char* step) {
  return {Errc::kUnsupported,
          fmt::format("EGL: {}: error 0x{:04X}; packages libegl1, libegl-mesa0 and "
                      "libgl1-mesa-dri provide a software renderer",
                      step, eglGetError())};
}

// Returns the PCI address of the device with this DRM node; empty if it has none.
std::string pciOf(const std::string& node) {
  namespace fs = std::filesystem;
  if (node.empty()) return {};
  std::error_code error;
  const fs::path link = fs::path("/sys/class/drm") / fs::path(node).filename() / "device";
  const std::string name = fs::canonical(link, error).filename().string();
  const bool is_pci = name.size() == 12 && name[4] == ':' && name[7] == ':' && name[10] == '.';
  return !error && is_pci ? name : std::string();
}

class EglContext final : public GlContext {
 public:
  // `device`: whose display it is; null for the display of no device.
  static Result<std::unique_ptr<GlContext>> make(EGLDisplay display, const EglDevice* device) {
    auto context = std::make_unique<EglContext>();
    if (const auto made = context->create(display); !made) return made.error();
    if (device) {
      context->info_.node = device->node;
      context->info_.pci = device->pci;
      context->info_.software |= device->software;
    }
    context->on_device_ = device != nullptr;
    if (device) context->folder_ = deviceFolder(device->node.empty() ? device->card : device->node);
    return std::unique_ptr<GlContext>(std::move(context));
  }
  EglContext() = default;
  ~EglContext() override {
    if (display_ == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    // No eglTerminate: the whole process shares the display, and another context may use it.
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  Result<std::unique_ptr<GlContext>> makeFurther() const override {
    if (info_.software && !on_device_) {
      for (const EglDevice& device : eglDevices()) {
        if (device.software) return makeEglContext(device);
      }
    }
    auto further = make(display_, nullptr);
    if (!further) return further;
    auto& context = static_cast<EglContext&>(**further);
    context.info_ = info_;
    context.folder_ = folder_;
    return further;
  }

  Result<RenderTarget> importTarget(const DmaBuf& buffer) const override {
    // Mesa's software renderer offers the import even where it would then crash: on a display
    // without a device, or if it may not map the device's memory.
    if (info_.software) return Error{Errc::kUnsupported, "the CPU draws, not the display's GPU"};
    // Another GPU's driver may take the memory and then draw into a copy of it, or hang.
    if (folder_.empty() || folder_ != buffer.device) {
      return Error{Errc::kUnsupported,
                   fmt::format("the display's memory belongs to another device ({}) than the GPU "
                               "that draws ({})",
                               buffer.device.empty() ? "unknown" : buffer.device,
                               folder_.empty() ? "unknown" : folder_)};
    }
    return gl::importTarget(display_, api_, buffer);
  }

 private:
  Result<Ok> create(EGLDisplay display) {
    display_ = display;
    if (display_ == EGL_NO_DISPLAY) return eglError("no display without a window system");
    if (!eglInitialize(display_, nullptr, nullptr)) return eglError("initialisation");
    if (!eglBindAPI(EGL_OPENGL_API)) return eglError("no desktop OpenGL");
    const bool tells_of_reset = createContext(true);
    if (!tells_of_reset && !createContext(false)) return eglError("no OpenGL 3.3 core context");
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      return eglError("no context without a surface");
    }
    auto api = loadApi([](const char* name) { return eglGetProcAddress(name); });
    if (!api) return api.error();
    api_ = *api;
    if (tells_of_reset) {
      api_.GetGraphicsResetStatus = reinterpret_cast<PFNGLGETGRAPHICSRESETSTATUSPROC>(
          eglGetProcAddress("glGetGraphicsResetStatus"));
    }
    info_ = rendererOf(api_, "EGL");
    return Ok{};
  }

  // `tells_of_reset`: asks to be told of a reset of the GPU, which not every driver supports.
  bool createContext(bool tells_of_reset) {
    std::vector<EGLint> attributes = {
        EGL_CONTEXT_MAJOR_VERSION,       3,
        EGL_CONTEXT_MINOR_VERSION,       3,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (tells_of_reset) {
      attributes.push_back(EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY);
      attributes.push_back(EGL_LOSE_CONTEXT_ON_RESET);
    }
    attributes.push_back(EGL_NONE);
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    return context_ != EGL_NO_CONTEXT;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  bool on_device_ = false;  // the display is a device's
  std::string folder_;      // deviceFolder() of that device; empty if unknown
};

EglDevice deviceOf(EGLDeviceEXT handle, PFNEGLQUERYDEVICESTRINGEXTPROC text) {
  const char* const extensions = text(handle, EGL_EXTENSIONS);
  const auto has = [&](const char* name) { return extensions && std::strstr(extensions, name); };
  const auto string = [&](const char* extension, EGLint name) {
    const char* const value = has(extension) ? text(handle, name) : nullptr;
    return std::string(value ? value : "");
  };
  EglDevice device{.handle = handle, .software = has("EGL_MESA_device_software")};
  device.card = string("EGL_EXT_device_drm", EGL_DRM_DEVICE_FILE_EXT);
  device.node = string("EGL_EXT_device_drm_render_node", EGL_DRM_RENDER_NODE_FILE_EXT);
  device.pci = pciOf(device.node.empty() ? device.card : device.node);
  return device;
}

}  // namespace

std::vector<EglDevice> eglDevices() {
  const auto query =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      eglGetProcAddress("eglQueryDeviceStringEXT"));
  EGLDeviceEXT handles[16];
  EGLint count = 0;
  std::vector<EglDevice> devices;
  if (!query || !text || !query(std::size(handles), handles, &count)) return devices;
  for (EGLint i = 0; i < count; ++i) devices.push_back(deviceOf(handles[i], text));
  return devices;
}

Result<std::unique_ptr<GlContext>> makeEglContext(const EglDevice& device) {
  return EglContext::make(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device.handle, nullptr),
                          &device);
}

Result<std::unique_ptr<GlContext>> makeSurfacelessContext() {
  return EglContext::make(
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), nullptr);
}

}  // namespace merlin::render::gl
