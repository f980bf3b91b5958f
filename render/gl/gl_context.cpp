#include "render/gl/gl_context.h"

#include <cstdlib>

#include <malloc.h>

#include "render/gl/egl_context.h"
#include "render/gl/gpu_list.h"
#include "render/gl/osmesa_context.h"

namespace merlin::render::gl {
namespace {

using Made = Result<std::unique_ptr<GlContext>>;

// If Mesa chooses a GPU although none is wanted, uses its software device.
Made makeSoftwareContext() {
  Made made = makeSurfacelessContext();
  if (!made || (*made)->info().software) return made;
  made = std::unique_ptr<GlContext>();
  for (const EglDevice& device : eglDevices()) {
    if (device.software) return makeEglContext(device);
  }
  return Error{Errc::kUnsupported,
               "render.gpu: EGL has no software renderer; package libgl1-mesa-dri provides one"};
}

// Skips devices whose driver draws with the CPU all the same, as a virtual machine's does.
Made makeAnyContext() {
  for (const EglDevice& device : eglDevices()) {
    if (device.software) continue;
    Made made = makeEglContext(device);
    if (made && !(*made)->info().software) return made;
  }
  return makeSurfacelessContext();
}

Made makeChosenContext(const std::string& gpu) {
  const std::vector<Gpu> gpus = listGpus();
  const auto chosen = chooseGpu(gpus, gpu);
  if (!chosen) return Error{chosen.error().code, "render.gpu: " + chosen.error().what};
  if (gpus[*chosen].renderer.software) return makeSoftwareContext();
  return makeEglContext(eglDevices()[*chosen]);
}

}  // namespace

Result<RenderTarget> GlContext::importTarget(const DmaBuf& /*buffer*/) const {
  return Error{Errc::kUnsupported, info_.library + " draws only into memory of its own"};
}

Result<Ok> checkGpu(GlBackend backend, const std::string& gpu) {
  if (gpu == kAnyGpu || gpu == kNoGpu) return Ok{};
  if (backend == GlBackend::kOsmesa) {
    return Error{Errc::kInvalidArgument,
                 "names a GPU, but OSMesa draws in software: set backend to egl, or gpu to none"};
  }
  const auto chosen = chooseGpu(listGpus(), gpu);
  if (!chosen) return chosen.error();
  return Ok{};
}

Made makeGlContext(GlBackend backend, const std::string& gpu) {
  if (backend == GlBackend::kOsmesa) {
    if (const auto good = checkGpu(backend, gpu); !good)
      return Error{good.error().code, "render.gpu: " + good.error().what};
    return makeOsmesaContext();
  }
  if (gpu == kAnyGpu) return makeAnyContext();
  return gpu == kNoGpu ? makeSoftwareContext() : makeChosenContext(gpu);
}

void prepareSoftwareGl(int raster_threads, bool only) {
  // NOLINTBEGIN(concurrency-mt-unsafe): before any thread starts, says the contract
  ::setenv("LP_NUM_THREADS", std::to_string(raster_threads).c_str(), 0);
  if (only) ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  // NOLINTEND(concurrency-mt-unsafe)
  // llvmpipe allocates and frees blocks of 64 kB in each frame. By default glibc would return them
  // to the kernel, and the page faults of the next frame would cost up to a third of its time.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 30);
  ::mallopt(M_TRIM_THRESHOLD, 2'000'000'000);
}

}  // namespace merlin::render::gl
