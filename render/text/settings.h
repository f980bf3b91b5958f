// Settings of what is drawn over the operator's tile.
#pragma once

namespace merlin::render::text {

struct OperatorSettings {
  bool overlay = false;  // whether rate, detail, devices and messages are drawn over the picture
};

}  // namespace merlin::render::text
