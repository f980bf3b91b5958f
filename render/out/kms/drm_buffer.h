// Buffers in the computer's memory that a card scans out ("dumb" ones, in the kernel's words).
#pragma once

#include <memory>

#include "daemon/base/unique_fd.h"
#include "render/out/kms/card.h"

namespace merlin::render::out::kms {

// The device file. Shared by the card and its buffers, which may outlive it.
using DrmFile = std::shared_ptr<UniqueFd>;

// A black buffer. Errors: kIo: the card has no memory for it.
Result<std::shared_ptr<Buffer>> makeDumbBuffer(const DrmFile& file, int width, int height);

}  // namespace merlin::render::out::kms
