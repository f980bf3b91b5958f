// Settings of what is drawn over the operator's tile.
#pragma once

namespace merlin::render::text {

struct OperatorSettings {
  bool overlay = false;  // whether rate, detail, devices and messages are drawn over the picture
  bool panel = false;    // whether there is a panel with buttons (render/panel)
};

}  // namespace merlin::render::text
