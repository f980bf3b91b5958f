#include "render/gl/gl_context.h"

#include <cstdlib>
#include <cstring>
#include <iterator>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <malloc.h>

namespace merlin::render::gl {
namespace {

using AnyFunction = void (*)();

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

Error eglError(const char* step) {
  return {Errc::kUnsupported,
          fmt::format("EGL: {}: error 0x{:04X}; packages libegl1, libegl-mesa0 and "
                      "libgl1-mesa-dri provide a software renderer",
                      step, eglGetError())};
}

class EglContext final : public GlContext {
 public:
  static Result<std::unique_ptr<GlContext>> make(EglDisplay display) {
    auto context = std::make_unique<EglContext>();
    if (const auto made = context->create(display); !made) return made.error();
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

 private:
  // The EGL device of the software renderer, if there is one, else the first device.
  static EGLDeviceEXT device() {
    const auto query =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    const auto text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
        eglGetProcAddress("eglQueryDeviceStringEXT"));
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (!query || !text || !query(std::size(devices), devices, &count) || count == 0)
      return EGL_NO_DEVICE_EXT;
    for (EGLint i = 0; i < count; ++i) {
      const char* extensions = text(devices[i], EGL_EXTENSIONS);
      if (extensions && std::strstr(extensions, "EGL_MESA_device_software")) return devices[i];
    }
    return devices[0];
  }

  Result<Ok> create(EglDisplay display) {
    if (display == EglDisplay::kDevice) {
      const EGLDeviceEXT from = device();
      if (from == EGL_NO_DEVICE_EXT) return eglError("no device for a second display");
      display_ = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, from, nullptr);
    } else {
      display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    }
    if (display_ == EGL_NO_DISPLAY) return eglError("no display without a window system");
    if (!eglInitialize(display_, nullptr, nullptr)) return eglError("initialisation");
    if (!eglBindAPI(EGL_OPENGL_API)) return eglError("no desktop OpenGL");
    const EGLint kAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                  3,
                                  EGL_CONTEXT_MINOR_VERSION,
                                  3,
                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                  EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                  EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes);
    if (context_ == EGL_NO_CONTEXT) return eglError("no OpenGL 3.3 core context");
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      return eglError("no context without a surface");
    }
    auto api = loadApi([](const char* name) { return eglGetProcAddress(name); });
    if (!api) return api.error();
    api_ = *api;
    renderer_ = fmt::format("EGL, {}", reinterpret_cast<const char*>(api_.GetString(GL_RENDERER)));
    return Ok{};
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

// libOSMesa, loaded with RTLD_LOCAL so that its GL symbols do not conflict with those of EGL. It is
// never unloaded, since Mesa crashes if it is.
class OsmesaLibrary {
 public:
  static Result<OsmesaLibrary> open() {
    OsmesaLibrary library;
    library.handle_ = ::dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (!library.handle_) {
      return Error{Errc::kUnsupported,
                   fmt::format("OSMesa: {}; package libosmesa6 provides it", ::dlerror())};
    }
    return library;
  }
  template <typename F>
  F function(const char* name) const {
    return reinterpret_cast<F>(::dlsym(handle_, name));
  }

 private:
  void* handle_ = nullptr;
};

class OsmesaContext final : public GlContext {
 public:
  static Result<std::unique_ptr<GlContext>> make() {
    const auto library = OsmesaLibrary::open();
    if (!library) return library.error();
    auto context = std::make_unique<OsmesaContext>(*library);
    if (const auto made = context->create(); !made) return made.error();
    return std::unique_ptr<GlContext>(std::move(context));
  }
  explicit OsmesaContext(const OsmesaLibrary& library) : library_(library) {}
  ~OsmesaContext() override {
    if (context_) library_.function<void (*)(OSMesaContext)>("OSMesaDestroyContext")(context_);
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

 private:
  Result<Ok> create() {
    const auto make =
        library_.function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    const auto makeCurrent = library_.function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    const auto resolve = library_.function<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress");
    if (!make || !makeCurrent || !resolve)
      return Error{Errc::kUnsupported, "OSMesa: the library is too old"};
    const int kAttributes[] = {OSMESA_FORMAT,
                               OSMESA_RGBA,
                               OSMESA_PROFILE,
                               OSMESA_CORE_PROFILE,
                               OSMESA_CONTEXT_MAJOR_VERSION,
                               3,
                               OSMESA_CONTEXT_MINOR_VERSION,
                               3,
                               0};
    context_ = make(kAttributes, nullptr);
    // OSMesa requires a buffer to make a context current. It has one pixel and is not used:
    // everything is drawn into frame buffer objects.
    if (!context_ || !makeCurrent(context_, unused_.data(), GL_UNSIGNED_BYTE, 1, 1)) {
      return Error{Errc::kUnsupported, "OSMesa: no OpenGL 3.3 core context"};
    }
    auto api =
        loadApi([&](const char* name) { return reinterpret_cast<AnyFunction>(resolve(name)); });
    if (!api) return api.error();
    api_ = *api;
    renderer_ =
        fmt::format("OSMesa, {}", reinterpret_cast<const char*>(api_.GetString(GL_RENDERER)));
    return Ok{};
  }

  OsmesaLibrary library_;
  OSMesaContext context_ = nullptr;
  std::vector<unsigned char> unused_ = std::vector<unsigned char>(4);
};

}  // namespace

Result<std::unique_ptr<GlContext>> makeGlContext(GlBackend backend, EglDisplay display) {
  return backend == GlBackend::kEgl ? EglContext::make(display) : OsmesaContext::make();
}

void prepareSoftwareGl(int raster_threads) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): before any thread starts, says the contract
  ::setenv("LP_NUM_THREADS", std::to_string(raster_threads).c_str(), 0);
  // llvmpipe allocates and frees blocks of 64 kB in each frame. By default glibc would return them
  // to the kernel, and the page faults of the next frame would cost up to a third of its time.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 30);
  ::mallopt(M_TRIM_THRESHOLD, 2'000'000'000);
}

}  // namespace merlin::render::gl
