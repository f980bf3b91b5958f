// Shared by the classes that use libdrm: owning pointers to its objects, and errno as text.
#pragma once

#include <cstring>
#include <memory>
#include <string>

#include <xf86drmMode.h>

namespace merlin::render::out::kms {

template <typename T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

inline Owned<drmModeRes> resourcesOf(int fd) {
  return {drmModeGetResources(fd), drmModeFreeResources};
}

inline std::string errnoText(int code) {
  return std::strerror(code);  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace merlin::render::out::kms
