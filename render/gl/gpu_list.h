// The GPUs of this machine, as EGL lists them, and the choice of one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/gl/renderer_info.h"

namespace merlin::render::gl {

// A device of EGL. The software renderer is one too.
struct Gpu {
  RendererInfo renderer{};  // without name if it cannot be used
  std::string card{};       // DRM node of its displays, "/dev/dri/card0"; empty if unknown
  std::string fault{};      // why it cannot be used; empty: it can
};

// Lists EGL's devices, in EGL's order. Empty if there is no EGL or it cannot list devices. Creates
// and destroys a context on each GPU, which takes up to some tenths of a second each and leaves no
// context current on the calling thread.
std::vector<Gpu> listGpus();

// Returns the index in `gpus` of the one that `wanted` names: its index, DRM node, PCI address, or
// a part of its name (upper or lower case). Errors: kInvalidArgument (no GPU matches, or several
// do), with a list of all. Pure.
Result<std::size_t> chooseGpu(std::span<const Gpu> gpus, const std::string& wanted);

// A line for each GPU: "0: NVIDIA H100 (NVIDIA Corporation, 4.6.0 NVIDIA 535.54, ...)". Pure.
std::vector<std::string> describeGpus(std::span<const Gpu> gpus);

}  // namespace merlin::render::gl
