// SdlWindow: one window on the desktop, through SDL2: shows pictures, reads mouse and keys.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/out/window/fit.h"
#include "render/out/window/messages.h"
#include "render/out/window/window_commands.h"

struct SDL_KeyboardEvent;
struct SDL_Surface;
struct SDL_Window;
union SDL_Event;

namespace merlin::render::out {

// At most one in a process. Thread-bound to the thread that opened it. Any call may wait for the X
// server without limit, and end the process if it goes away.
class SdlWindow {
 public:
  // Errors: kIo (there is no display, or no such monitor).
  static Result<std::unique_ptr<SdlWindow>> open(const WindowForm& form);
  ~SdlWindow();
  SdlWindow(const SdlWindow&) = delete;
  SdlWindow& operator=(const SdlWindow&) = delete;

  // Shows a picture of the form's size, RGBA, rows from top to bottom without padding. Returns when
  // the display has it. Errors: kIo.
  Result<Ok> show(std::span<const std::uint8_t> pixels);

  // Handles what has happened since the last call. Returns false if a person closed the window.
  bool handleEvents();
  // Returns the commands that a person has given since the last call, each "NAME ARGUMENT": motions
  // of the pointer on the operator's panel, then those of WindowCommands::take().
  std::vector<std::string> takeCommands();

 private:
  struct Freed {
    void operator()(SDL_Window* window) const;
    void operator()(SDL_Surface* surface) const;
  };
  SdlWindow(const WindowForm& form, SDL_Window* window) : form_(form), window_(window) {
    if (form.panel.width > 0) panel_.place(form.panel);
  }

  bool handle(const SDL_Event& event);
  void act(const SDL_Event& event);
  bool pointOnPanel(const SDL_Event& event);
  void press(const SDL_KeyboardEvent& event);
  void toggleFullscreen();
  Result<Ok> draw();

  WindowForm form_;
  std::unique_ptr<SDL_Window, Freed> window_;
  std::unique_ptr<SDL_Surface, Freed> picture_;  // the last one, in the window's format
  PixelSize drawn_;                              // size of the window when it was last drawn
  WindowCommands commands_;
  PanelPointer panel_;
};

}  // namespace merlin::render::out
