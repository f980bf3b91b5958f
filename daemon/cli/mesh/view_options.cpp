#include "daemon/cli/mesh/view_options.h"

#include <algorithm>
#include <iterator>

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
      .oneOf({std::begin(render::gl::kGlBackendNames), std::end(render::gl::kGlBackendNames)})
      .showDefault();
}

render::frame::ModelView View::asAsked() const {
  render::frame::ModelView view = static_cast<const render::frame::ModelView&>(*this);
  const auto* named = std::find(std::begin(render::gl::kGlBackendNames),
                                std::end(render::gl::kGlBackendNames), backend_name_);
  view.backend =
      static_cast<render::gl::GlBackend>(named - std::begin(render::gl::kGlBackendNames));
  return view;
}

}  // namespace merlin::cli
