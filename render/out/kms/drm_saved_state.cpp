#include "render/out/kms/drm_saved_state.h"

#include <utility>

#include "render/out/kms/drm_objects.h"

namespace merlin::render::out::kms {

DrmSavedState::DrmSavedState(int fd, DrmProperties& properties) {
  const auto resources = resourcesOf(fd);
  for (int i = 0; resources && i < resources->count_crtcs; ++i) {
    const Owned<drmModeCrtc> crtc(drmModeGetCrtc(fd, resources->crtcs[i]), drmModeFreeCrtc);
    if (!crtc) continue;
    Saved saved{*crtc, {}};
    for (int c = 0; c < resources->count_connectors; ++c) {
      const Id id = resources->connectors[c];
      if (properties.valueOf(fd, id, DRM_MODE_OBJECT_CONNECTOR, "CRTC_ID") == crtc->crtc_id)
        saved.connectors.push_back(id);
    }
    saved_.push_back(std::move(saved));
  }
}

void DrmSavedState::restore(int fd) {
  for (Saved& saved : saved_) {
    drmModeCrtc& crtc = saved.crtc;
    const bool was_on = crtc.mode_valid && crtc.buffer_id != 0 && !saved.connectors.empty();
    if (!was_on) {
      drmModeSetCrtc(fd, crtc.crtc_id, 0, 0, 0, nullptr, 0, nullptr);
      continue;
    }
    drmModeSetCrtc(fd, crtc.crtc_id, crtc.buffer_id, crtc.x, crtc.y, saved.connectors.data(),
                   static_cast<int>(saved.connectors.size()), &crtc.mode);
  }
}

}  // namespace merlin::render::out::kms
