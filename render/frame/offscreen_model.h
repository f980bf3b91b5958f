// OffscreenModel: images of a model at any level, without a wall or a window.
#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/frame/frame_renderer.h"
#include "render/gl/settings.h"
#include "render/image/image.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

// From where the model is seen, and how it is drawn.
struct ModelView {
  int width = 640, height = 480;  // of the image [px]
  double yaw_deg = 30;            // the model is turned about the vertical axis,
  double pitch_deg = 0;           // and before that about the horizontal one
  GlBackend backend = GlBackend::kEgl;
  ModelSettings model{};

  Eigen::Isometry3f T_eye_model() const;
};

// Thread-bound; one at a time, since each has an OpenGL context of its own.
class OffscreenModel {
 public:
  // Model and clock are borrowed. The model's bounding sphere fills the image; it is drawn at a
  // level as it is: neither view-dependent nor on its way to another level. Errors: kUnsupported
  // (no OpenGL of that kind), ModelContent::make()'s. REQUIRES: prepareSoftwareGl() was called.
  static Result<OffscreenModel> make(const Dendrogram& model, const ModelView& view,
                                     const Clock& clock);

  Image draw(std::size_t level);

 private:
  explicit OffscreenModel(const ModelView& view) : view_(view) {}

  ModelView view_;
  std::unique_ptr<const TilePlan> plan_;  // the renderer keeps its address
  std::unique_ptr<FrameRenderer> renderer_;
};

}  // namespace merlin::render
