// PanelPointer: which events of a pointer, in a window or a VNC client, belong to the operator's
// panel, and the command operator_pointer that tells merlind of them. Pure.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "daemon/base/clock.h"

namespace merlin {

// Thread-bound.
class PanelPointer {
 public:
  // Where a picture shows the panel [px]. A pixel x, y of the picture is x + to_frame_x,
  // y + to_frame_y of the wall's frame.
  struct Place {
    int x = 0, y = 0, width = 0, height = 0;
    int to_frame_x = 0, to_frame_y = 0;

    bool operator==(const Place&) const = default;
  };
  // Sets where the picture shows the panel; nothing: the picture does not show it. If the place
  // changes, a held button is released.
  void place(const std::optional<Place>& place);

  // Reports that the pointer is at a pixel of the picture. `pressed`: whether its (left) button is
  // pressed. Returns true if the panel takes the event, which must then have no other effect. A
  // drag belongs to the panel only if it began there.
  bool point(int x, int y, bool pressed);
  // Reports that the pointer has left the picture, or the finger the screen.
  void leave();

  // Returns the argument of the next command operator_pointer; nothing if none is due. While the
  // button is held, the command is repeated every kRepeat, so that merlind can release the button
  // if the commands cease. Motions since the last call are merged into one; presses and releases
  // are not.
  std::optional<std::string> take(Timestamp now);

  static constexpr Duration kRepeat = std::chrono::milliseconds(500);

 private:
  struct Told {
    int x = 0, y = 0;
    bool pressed = false, out = false;
    bool operator==(const Told&) const = default;
  };
  void tell(const Told& told);

  std::optional<Place> place_;
  bool pressed_ = false;  // whether the button is pressed
  bool held_ = false;     // whether it was pressed on the panel and is still pressed
  Told last_{0, 0, false, true};
  struct Waiting {
    Told told;
    bool moves = false;  // a mere motion: button and `out` are as in the event before
  };
  std::deque<Waiting> waiting_;  // bounded
  Timestamp taken_{};
};

}  // namespace merlin
