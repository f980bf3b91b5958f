// makeDrmScanout(): the Scanout of the Linux kernel's DRM devices.
#pragma once

#include <memory>
#include <string>

#include "render/out/kms/card.h"
#include "render/out/kms/drm_buffer.h"

namespace merlin::render::out::kms {

// `file`: the open device file of the card at `path`. Buffers can be read only while `file` is DRM
// master.
std::shared_ptr<Scanout> makeDrmScanout(DrmFile file, std::string path);

}  // namespace merlin::render::out::kms
