#include "render/gl/osmesa_context.h"

#include <vector>

#include <GL/osmesa.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include "render/gl/load_api.h"

namespace merlin::render::gl {
namespace {

using AnyFunction = void (*)();

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

  Result<std::unique_ptr<GlContext>> makeFurther() const override {
    return Error{Errc::kUnsupported,
                 "render.contexts: OSMesa has only one context in a process; set it to 1, or "
                 "render.backend to egl"};
  }

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
    info_ = rendererOf(api_, "OSMesa");
    return Ok{};
  }

  OsmesaLibrary library_;
  OSMesaContext context_ = nullptr;
  std::vector<unsigned char> unused_ = std::vector<unsigned char>(4);
};

}  // namespace

Result<std::unique_ptr<GlContext>> makeOsmesaContext() { return OsmesaContext::make(); }

}  // namespace merlin::render::gl
