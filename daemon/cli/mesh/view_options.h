// View: command-line options of `merlin mesh` that set viewpoint and rendering style of a model.
#pragma once

#include <string>

#include "daemon/cli/arguments.h"
#include "render/frame/offscreen_model.h"

namespace merlin::cli {

struct View : render::frame::ModelView {
  void addTo(Command command);  // adds --yaw, --pitch, --show, --brightness, --backend

  // Returns the view that the options describe, with the backend.
  render::frame::ModelView asAsked() const;

 private:
  std::string backend_name_ = "egl";
};

}  // namespace merlin::cli
