// InputMap: translates pointer and keys of a VNC client into commands for the wall
// (daemon/base/commands.h). Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>

#include "daemon/base/panel_pointer.h"

namespace merlin::rfb {

struct Request {
  std::string command, argument = {};
  bool operator==(const Request&) const = default;
};

// A drag turns the model or the viewer, whichever the ball moves; a drag with Shift or the middle
// button moves it, and the wheel moves it nearer or farther. README.md lists the keys.
// Thread-bound.
class InputMap {
 public:
  // Handles a pointer event at pixel x, y of a picture that is `height` pixels high. `buttons`: as
  // in RFB, bit 0 left, 1 middle, 2 right, 3 wheel up, 4 wheel down. Events that belong to the
  // operator's panel go to panel() and have no other effect.
  void pointer(unsigned buttons, int x, int y, int height);
  PanelPointer& panel() noexcept { return panel_; }
  // Handles a key that is pressed or released. `keysym`: an X11 keysym, as in RFB.
  void key(std::uint32_t keysym, bool pressed);

  // Returns the next request for the wall; nothing if there is none. All motion since the last
  // request for motion becomes one request, so that no queue builds up while the wall is slow to
  // answer. At most 8 other requests wait; further ones are dropped.
  std::optional<Request> take();

 private:
  struct Step {
    double way[3] = {}, turn_deg[3] = {};
  };
  bool pressesArrow(std::uint32_t keysym);
  bool panelTakes(unsigned buttons, int x, int y);

  PanelPointer panel_;
  Step step_;
  std::deque<std::string> commands_;
  std::set<std::uint32_t> held_;  // keys that are pressed; bounded
  unsigned buttons_ = 0;
  int x_ = 0, y_ = 0;
};

}  // namespace merlin::rfb
