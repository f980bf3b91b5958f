#include "daemon/cli/mesh/view_options.h"

namespace merlin::cli {

void View::addTo(Command command) {
  command.option("--yaw", yaw_deg, "Rotation about the vertical axis, in degrees").showDefault();
  command
      .option(
          "--pitch", pitch_deg,
          "Rotation about the horizontal axis, in degrees, applied before the yaw; -90 for a model "
          "whose z axis points up")
      .showDefault();
  command
      .option("--show", model.show.feature,
              "Name of the feature that the colours show (a feature with one value on a scale from "
              "dark blue to yellow); the default is the model's own colours")
      .typeName("NAME");
  command.option("--brightness", model.style.brightness, "Factor that multiplies the colours")
      .range(0.1, 10.0)
      .showDefault();
  command.option("--backend", backend_name_, "OpenGL implementation that draws without a window")
      .oneOf({"egl", "osmesa"})
      .showDefault();
}

render::frame::ModelView View::asAsked() const {
  render::frame::ModelView view = static_cast<const render::frame::ModelView&>(*this);
  view.backend =
      backend_name_ == "osmesa" ? render::gl::GlBackend::kOsmesa : render::gl::GlBackend::kEgl;
  return view;
}

}  // namespace merlin::cli
