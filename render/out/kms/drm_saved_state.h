// DrmSavedState: what the displays of a card showed before the wall.
#pragma once

#include <vector>

#include <xf86drmMode.h>

#include "render/out/kms/card.h"
#include "render/out/kms/drm_properties.h"

namespace merlin::render::out::kms {

// Thread-bound.
class DrmSavedState {
 public:
  DrmSavedState() = default;
  DrmSavedState(int fd, DrmProperties& properties);

  // Shows it again; CRTCs that were off are switched off. REQUIRES: DRM master.
  void restore(int fd);

 private:
  struct Saved {
    drmModeCrtc crtc;
    std::vector<Id> connectors;
  };
  std::vector<Saved> saved_;
};

}  // namespace merlin::render::out::kms
