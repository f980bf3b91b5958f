// Port: what the scene is told of the devices. Implemented by DeviceFeed and by a fake in tests.
#pragma once

#include "daemon/base/clock.h"
#include "render/scene/scene.h"

namespace merlin::wall {

// Thread-bound to the wall's thread.
class InputFeed {
 public:
  virtual ~InputFeed() = default;

  // The newest of everything that is well; never waits.
  virtual render::SceneInput read(Timestamp now) = 0;

  // Of the newest sample that read() gave last; zero where there was none.
  virtual Duration age() const noexcept = 0;
};

}  // namespace merlin::wall
