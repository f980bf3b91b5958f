// Settings of an output of kind window.
#pragma once

#include <string>

#include "daemon/base/setting_fault.h"

namespace merlin::render::out {

// How a picture is shown in a window of another size. kFit: scaled to the largest size that fits,
// with black bars. kNone: at its own size, in the middle; what is larger than the window is cut
// off. In the order of kWindowScaleNames.
enum class WindowScale { kFit, kNone };
inline constexpr const char* kWindowScaleNames[] = {"fit", "none"};

// What happens when a person closes the window: kHealth: merlind goes on, and the output has a
// fault; kStop: merlind stops. In the order of kOnCloseNames.
enum class OnClose { kHealth, kStop };
inline constexpr const char* kOnCloseNames[] = {"health", "stop"};

struct WindowSettings {
  std::string title = "MERLIN";
  int monitor = 0;            // number of the monitor, counted from 0 by the desktop
  int x = -1, y = -1;         // upper left corner on the monitor; -1: in the middle [px]
  int width = 0, height = 0;  // of the window; 0: those of the picture [px]
  bool fullscreen = false;
  bool border = true;  // whether the desktop draws a frame and a title around the window
  WindowScale scale = WindowScale::kFit;
  OnClose on_close = OnClose::kHealth;
  bool input = true;  // whether mouse and keys in the window act on the wall

  bool operator==(const WindowSettings&) const = default;
};

// Longest title [bytes].
inline constexpr std::size_t kLongestTitle = 127;

// Checks for: a title that is too long; a width without a height, or the reverse; a position or a
// size of a fullscreen window. Pure.
SettingFaults validate(const WindowSettings& window);

}  // namespace merlin::render::out
