// DmaBuf: an image in the memory of a graphics card, described so that code that knows the card's
// displays and code that draws can share it without knowing each other.
#pragma once

#include <cstdint>
#include <string>

#include <sys/types.h>

#include "daemon/base/unique_fd.h"

namespace merlin {

// A dma-buf of the kernel, with one plane of pixels. A component that imports it keeps the memory
// for as long as it needs it, even if this object is destroyed. Reader and writer take turns:
// neither uses the memory before the other has finished.
struct DmaBuf {
  UniqueFd file{};
  int width = 0, height = 0;   // [px]
  std::uint32_t format = 0;    // order of the channels: a code of the kernel's drm_fourcc.h
  std::uint64_t modifier = 0;  // order of the pixels, also of drm_fourcc.h; 0: row by row
  std::uint32_t offset = 0;    // [bytes] of the first pixel
  std::uint32_t pitch = 0;     // [bytes] from one row to the next
  std::string device{};        // deviceFolder() of the card to which the memory belongs
};

// Returns the folder in /sys of the device that belongs to this device node; empty if there is
// none. All nodes of a GPU, such as /dev/dri/card0 and /dev/dri/renderD128, have the same folder.
std::string deviceFolder(dev_t node);
// Returns the folder of the device node with this path; empty also if there is no such node.
std::string deviceFolder(const std::string& path);

}  // namespace merlin
