// Buffers in the computer's memory that a card scans out ("dumb" ones, in the kernel's words).
#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "daemon/base/unique_fd.h"
#include "render/out/kms/card.h"

namespace merlin::render::out::kms {

// The device file. Shared by the card and its buffers, which may outlive the card.
struct DeviceFile : UniqueFd {
  using UniqueFd::UniqueFd;
  explicit DeviceFile(UniqueFd file) : UniqueFd(std::move(file)) {}

  // Set by the card when it ends: the displays go on showing the buffers, so none is removed.
  std::atomic<bool> stays_shown{false};
};
using DrmFile = std::shared_ptr<DeviceFile>;

// A black buffer. Errors: kIo: the card has no memory for it.
Result<std::shared_ptr<Buffer>> makeDumbBuffer(const DrmFile& file, int width, int height);

}  // namespace merlin::render::out::kms
