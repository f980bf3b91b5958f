// OffscreenModel: renders images of a model at any level, without a wall or a window.
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

namespace merlin::render::frame {

// The direction from which the model is seen, and how it is drawn.
struct ModelView {
  int width = 640, height = 480;  // of the image [px]
  double yaw_deg = 30;            // rotation of the model about the vertical axis
  double pitch_deg = 0;           // rotation about the horizontal axis, before the yaw
  gl::GlBackend backend = gl::GlBackend::kEgl;
  content::ModelSettings model{};

  Eigen::Isometry3f T_eye_model() const;
};

// Thread-bound. Only one may exist at a time, since each has its own OpenGL context.
class OffscreenModel {
 public:
  // Borrows `model` and `clock`. The model's bounding sphere fills the image. Levels are drawn as
  // they are: not view-dependent, and without geomorphing to another level. Errors: kUnsupported
  // (no OpenGL of that kind), those of ModelContent::make(). REQUIRES: prepareSoftwareGl() was
  // called.
  static Result<OffscreenModel> make(const lod::Dendrogram& model, const ModelView& view,
                                     const Clock& clock);

  image::Image draw(std::size_t level);

 private:
  explicit OffscreenModel(const ModelView& view) : view_(view) {}

  ModelView view_;
  std::unique_ptr<const tiles::TilePlan> plan_;  // the renderer keeps its address
  std::unique_ptr<FrameRenderer> renderer_;
};

}  // namespace merlin::render::frame
