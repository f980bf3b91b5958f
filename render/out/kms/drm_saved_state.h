// DrmSavedState: saves what the displays of a card show, and restores it.
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

  // Sets the saved mode, buffer and connectors of each CRTC again; CRTCs that were off are switched
  // off. REQUIRES: DRM master.
  void restore(int fd);

 private:
  struct Saved {
    drmModeCrtc crtc;
    std::vector<Id> connectors;
  };
  std::vector<Saved> saved_;
};

}  // namespace merlin::render::out::kms
