// makeDumbBuffer(): makes buffers that the CPU writes and a card scans out (the kernel's "dumb
// buffers").
#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "daemon/base/unique_fd.h"
#include "render/out/kms/card.h"

namespace merlin::render::out::kms {

// A card's open device file. Shared by the card and its buffers, which may outlive the card.
struct DeviceFile : UniqueFd {
  using UniqueFd::UniqueFd;
  explicit DeviceFile(UniqueFd file) : UniqueFd(std::move(file)) {}

  // Set by the card's destructor if the displays go on showing its buffers; the buffers'
  // destructors then remove no frame buffer from the kernel.
  std::atomic<bool> stays_shown{false};
};
using DrmFile = std::shared_ptr<DeviceFile>;

// Makes a black buffer of this size [px]. Errors: kIo: the card has no memory for it.
Result<std::shared_ptr<Buffer>> makeDumbBuffer(const DrmFile& file, int width, int height);

}  // namespace merlin::render::out::kms
