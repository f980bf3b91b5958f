// WindowCommands: translates what a person does in a window with mouse and keys into commands of
// daemon/base/commands.h. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin::render::out {

// A key that is pressed. `name`: as SDL_GetKeyName() gives it, "Left" or "H".
struct PressedKey {
  std::string_view name;
  bool shift = false, ctrl = false;
  bool repeats = false;  // the key is held, and the keyboard repeats it
};

// Thread-bound.
class WindowCommands {
 public:
  // Handles a motion of the pointer with a button held, by right_px and down_px [px]. A drag over
  // the whole height of the window turns what the command `move` moves by 180 degrees, or shifts it
  // by 1.5 of its radii.
  enum class Drag { kTurn, kShift };
  void drag(Drag what, double right_px, double down_px, int window_height);
  // Handles a turn of the mouse wheel; positive notches (away from the person) bring the content
  // nearer.
  void wheel(double notches);
  // Handles a key; README.md lists the keys. A held key repeats only motions and the steps of the
  // alignment.
  void press(const PressedKey& key);

  // Returns the commands since the last call, "NAME ARGUMENT", in the order in which keys were
  // pressed; all motions together are one command, the last.
  std::vector<std::string> take();

 private:
  // The arguments of the command `move`: shifts in radii of the content, rotations in degrees.
  struct Motion {
    double right = 0, up = 0, nearer = 0, about_x_deg = 0, about_y_deg = 0;
  };
  bool moves(const PressedKey& key);

  Motion motion_;
  std::vector<std::string> commands_;
};

}  // namespace merlin::render::out
