// View: the options with which subcommands of `merlin mesh` say how a model is seen.
#pragma once

#include <string>

#include "daemon/cli/arguments.h"
#include "render/frame/offscreen_model.h"

namespace merlin::cli {

struct View : render::ModelView {
  void addTo(Command command);  // --yaw, --pitch, --show, --brightness, --backend

  // With the backend that --backend names.
  render::ModelView asAsked() const;

 private:
  std::string backend_name_ = "egl";
};

}  // namespace merlin::cli
