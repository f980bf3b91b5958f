// openDrmCard(): the Card of the Linux kernel's DRM devices, through libdrm.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/kept_files.h"
#include "render/out/kms/card.h"

namespace merlin::render::out::kms {

// Opens a card; `path` empty: the first of /dev/dri/card* that has connectors and takes atomic
// commits. As long as `kept_files` keeps its file, its displays keep the last picture when this
// process ends, and the process after this one goes on from there. `kept_files` outlives the card.
// Errors: kNotFound: there is no such card (the message lists the cards), or it has no connector;
// kIo: no permission, with the remedy; kUnsupported: no atomic mode setting or no dumb buffers.
Result<std::unique_ptr<Card>> openDrmCard(const std::string& path, KeptFiles& kept_files);

}  // namespace merlin::render::out::kms
