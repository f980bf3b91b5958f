#include "daemon/cli/mesh/view_options.h"

namespace merlin::cli {

void View::addTo(Command command) {
  command.option("--yaw", yaw_deg, "Turn about the vertical axis, degrees").showDefault();
  command
      .option("--pitch", pitch_deg,
              "Turn about the horizontal axis before it, degrees; -90 for a model whose up is z")
      .showDefault();
  command
      .option("--show", model.show.feature,
              "A feature as colours, one value on a scale from dark blue to yellow; without: the "
              "model's own")
      .typeName("NAME");
  command.option("--brightness", model.style.brightness, "Multiplies colours")
      .range(0.1, 10.0)
      .showDefault();
  command.option("--backend", backend_name_, "Which windowless OpenGL draws")
      .oneOf({"egl", "osmesa"})
      .showDefault();
}

render::ModelView View::asAsked() const {
  render::ModelView view = static_cast<const render::ModelView&>(*this);
  view.backend = backend_name_ == "osmesa" ? render::GlBackend::kOsmesa : render::GlBackend::kEgl;
  return view;
}

}  // namespace merlin::cli
