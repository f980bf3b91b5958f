// Cards of the Linux kernel (DRM), through libdrm.
#pragma once

#include <memory>
#include <string>

#include "render/out/kms/card.h"

namespace merlin::render::out::kms {

// Opens a card; `path` empty: the first of /dev/dri/card* that has connectors and takes atomic
// commits. Errors: kNotFound with the cards there are; kIo: no permission, with the way out;
// kUnsupported: no atomic mode setting or no dumb buffers.
Result<std::unique_ptr<Card>> openDrmCard(const std::string& path);

}  // namespace merlin::render::out::kms
