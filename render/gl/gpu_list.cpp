#include "render/gl/gpu_list.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/words.h"
#include "render/gl/egl_context.h"

namespace merlin::render::gl {
namespace {

std::string describe(std::size_t index, const Gpu& gpu) {
  const RendererInfo& r = gpu.renderer;
  std::vector<std::string> details;
  if (r.software) details.push_back("software");
  for (const std::string& detail : {r.vendor, r.driver, r.node, gpu.card, r.pci}) {
    if (!detail.empty()) details.push_back(detail);
  }
  if (!gpu.fault.empty()) details.push_back("cannot be used: " + gpu.fault);
  const std::string name = r.name.empty() ? "unknown" : r.name;
  return details.empty() ? fmt::format("{}: {}", index, name)
                         : fmt::format("{}: {} ({})", index, name, fmt::join(details, ", "));
}

Error cannotChoose(std::span<const Gpu> gpus, const std::string& wanted, const char* why) {
  const std::vector<std::string> all = describeGpus(gpus);
  return {
      Errc::kInvalidArgument,
      fmt::format("\"{}\" {}; this machine has: {}. Name one by its number, DRM node, PCI "
                  "address or a part of its name, or set auto or none",
                  wanted, why,
                  all.empty() ? "no GPU that EGL lists" : fmt::to_string(fmt::join(all, "; ")))};
}

// Returns whether `wanted` is an exact name of the GPU; exact names come before parts of names.
bool isNamed(const Gpu& gpu, const std::string& wanted) {
  return !wanted.empty() && (gpu.renderer.node == wanted || gpu.card == wanted ||
                             gpu.renderer.pci == wanted || "0000:" + wanted == gpu.renderer.pci);
}

}  // namespace

bool isSoftwareRenderer(std::string_view name) {
  const std::string lower = lowerCase(name);
  constexpr const char* kSoftware[] = {"llvmpipe", "softpipe", "swrast", "software", "swiftshader"};
  return std::ranges::any_of(
      kSoftware, [&](const char* word) { return lower.find(word) != std::string::npos; });
}

std::vector<std::string> describeGpus(std::span<const Gpu> gpus) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < gpus.size(); ++i) lines.push_back(describe(i, gpus[i]));
  return lines;
}

Result<std::size_t> chooseGpu(std::span<const Gpu> gpus, const std::string& wanted) {
  std::size_t number = 0;
  const char* const end = wanted.data() + wanted.size();
  const auto parsed = std::from_chars(wanted.data(), end, number);
  std::vector<std::size_t> found;
  if (!wanted.empty() && parsed.ec == std::errc() && parsed.ptr == end) {
    if (number < gpus.size()) found.push_back(number);
  } else {
    for (std::size_t i = 0; i < gpus.size(); ++i) {
      if (isNamed(gpus[i], wanted)) found.push_back(i);
    }
    const bool exact = !found.empty() || wanted.empty();
    for (std::size_t i = 0; !exact && i < gpus.size(); ++i) {
      const std::string name = lowerCase(gpus[i].renderer.name);
      if (name.find(lowerCase(wanted)) != std::string::npos) found.push_back(i);
    }
  }
  if (found.empty()) return cannotChoose(gpus, wanted, "is none of the GPUs");
  if (found.size() > 1) return cannotChoose(gpus, wanted, "is part of more than one GPU's name");
  if (!gpus[found[0]].fault.empty()) return cannotChoose(gpus, wanted, "cannot be used");
  return found[0];
}

std::vector<Gpu> listGpus() {
  std::vector<Gpu> gpus;
  for (const EglDevice& device : eglDevices()) {
    Gpu gpu;
    gpu.card = device.card;
    gpu.renderer.node = device.node;
    gpu.renderer.pci = device.pci;
    gpu.renderer.library = "EGL";
    gpu.renderer.software = device.software;
    // No context is created on it: its settings are read from the environment, which is not
    // prepared yet.
    if (device.software) {
      gpu.renderer.name = "Mesa llvmpipe";
    } else if (const auto context = makeEglContext(device)) {
      gpu.renderer = (*context)->info();
    } else {
      gpu.fault = context.error().what;
    }
    gpus.push_back(std::move(gpu));
  }
  return gpus;
}

}  // namespace merlin::render::gl
