#include "render/out/window/sdl_window.h"

#include <cstdlib>
#include <utility>

#include <SDL.h>
#include <fmt/format.h>

namespace merlin::render::out {
namespace {

Error sdlError(const char* what) {
  return {Errc::kIo, fmt::format("{}: {}", what, SDL_GetError())};
}

// Returns which display the environment names, in words for a message.
std::string displayName() {
  for (const char* name : {"WAYLAND_DISPLAY", "DISPLAY"}) {
    const char* const value = std::getenv(name);
    if (value && *value) return fmt::format("{} is {}", name, value);
  }
  return "neither DISPLAY nor WAYLAND_DISPLAY is set for merlind";
}

void setHints() {
  // SDL's other drivers would take over a console's display, or show nothing. Without
  // XDG_RUNTIME_DIR there is no Wayland, and its library would print a message at each attempt.
  SDL_SetHint(SDL_HINT_VIDEODRIVER, std::getenv("XDG_RUNTIME_DIR") ? "x11,wayland" : "x11");
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");  // llvmpipe would take the wall's processors
  SDL_SetHint(SDL_HINT_VIDEO_MINIMIZE_ON_FOCUS_LOSS, "0");
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  SDL_SetHint(SDL_HINT_APP_NAME, "MERLIN");
}

std::uint32_t flagsOf(const WindowForm& form) {
  if (form.fullscreen) return SDL_WINDOW_FULLSCREEN_DESKTOP;
  std::uint32_t flags = SDL_WINDOW_RESIZABLE;
  if (!form.border) flags |= SDL_WINDOW_BORDERLESS;
  return flags;
}

// Returns the window's place and size while it is not fullscreen [px].
SDL_Rect normalPlaceOf(const WindowForm& form, const SDL_Rect& monitor) {
  const auto middle =
      static_cast<int>(SDL_WINDOWPOS_CENTERED_DISPLAY(static_cast<std::uint32_t>(form.monitor)));
  return {form.x >= 0 ? monitor.x + form.x : middle, form.y >= 0 ? monitor.y + form.y : middle,
          form.width > 0 ? form.width : form.picture_width,
          form.height > 0 ? form.height : form.picture_height};
}

// Returns where to put the window. Without a window manager, a window stays where it was put even
// if it should cover the monitor.
SDL_Rect placeOf(const WindowForm& form, const SDL_Rect& monitor) {
  return form.fullscreen ? monitor : normalPlaceOf(form, monitor);
}

// Wraps the picture without alpha, since the window's pixels are opaque.
SDL_Surface* wrap(std::span<const std::uint8_t> pixels, const WindowForm& form) {
  SDL_Surface* const surface = SDL_CreateRGBSurfaceWithFormatFrom(
      const_cast<std::uint8_t*>(pixels.data()), form.picture_width, form.picture_height, 32,
      4 * form.picture_width, SDL_PIXELFORMAT_RGBA32);
  if (surface) SDL_SetSurfaceBlendMode(surface, SDL_BLENDMODE_NONE);
  return surface;
}

}  // namespace

void SdlWindow::Freed::operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
void SdlWindow::Freed::operator()(SDL_Surface* surface) const { SDL_FreeSurface(surface); }

Result<std::unique_ptr<SdlWindow>> SdlWindow::open(const WindowForm& form) {
  setHints();
  if (SDL_Init(SDL_INIT_VIDEO) != 0) {
    return Error{Errc::kIo,
                 fmt::format("no display can be reached ({}): {}", displayName(), SDL_GetError())};
  }
  const int monitors = SDL_GetNumVideoDisplays();
  SDL_Rect monitor;
  if (SDL_GetDisplayBounds(form.monitor, &monitor) != 0) {
    return Error{Errc::kIo,
                 fmt::format("there is no monitor {}: the display has {}, counted from 0",
                             form.monitor, monitors)};
  }
  const SDL_Rect at = placeOf(form, monitor);
  SDL_Window* const window = SDL_CreateWindow(std::string(textOf(form.title)).c_str(), at.x, at.y,
                                              at.w, at.h, flagsOf(form));
  if (!window) return sdlError("the window cannot be opened");
  form.fullscreen ? SDL_DisableScreenSaver() : SDL_EnableScreenSaver();
  if (form.fullscreen && !form.input) SDL_ShowCursor(SDL_DISABLE);
  return std::unique_ptr<SdlWindow>(new SdlWindow(form, window));
}

SdlWindow::~SdlWindow() {
  picture_.reset();
  window_.reset();
  SDL_Quit();
}

Result<Ok> SdlWindow::show(std::span<const std::uint8_t> pixels) {
  SDL_Surface* const screen = SDL_GetWindowSurface(window_.get());
  if (!screen) return sdlError("the window has no pixels");
  const std::unique_ptr<SDL_Surface, Freed> from(wrap(pixels, form_));
  if (!picture_ || picture_->format->format != screen->format->format) {
    picture_.reset(SDL_CreateRGBSurfaceWithFormat(0, form_.picture_width, form_.picture_height, 32,
                                                  screen->format->format));
  }
  if (!from || !picture_ || SDL_BlitSurface(from.get(), nullptr, picture_.get(), nullptr) != 0)
    return sdlError("the picture cannot be converted");
  return draw();
}

Result<Ok> SdlWindow::draw() {
  SDL_Surface* const screen = SDL_GetWindowSurface(window_.get());
  if (!screen) return sdlError("the window has no pixels");
  if (!picture_) return Ok{};
  const PixelRectangle at = fit({picture_->w, picture_->h}, {screen->w, screen->h}, form_.fit != 0);
  const bool covers = at.width >= screen->w && at.height >= screen->h;
  const bool resized = drawn_.width != screen->w || drawn_.height != screen->h;
  if (!covers && resized) SDL_FillRect(screen, nullptr, SDL_MapRGB(screen->format, 0, 0, 0));
  drawn_ = {screen->w, screen->h};
  SDL_Rect to{at.x, at.y, at.width, at.height};
  const bool same_size = at.width == picture_->w && at.height == picture_->h;
  const int drawn = same_size ? SDL_BlitSurface(picture_.get(), nullptr, screen, &to)
                              : SDL_SoftStretchLinear(picture_.get(), nullptr, screen, &to);
  if (drawn != 0 || SDL_UpdateWindowSurface(window_.get()) != 0)
    return sdlError("the picture cannot be shown");
  return Ok{};
}

bool SdlWindow::handleEvents() {
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) {
    if (!handle(event)) return false;
  }
  return true;
}

bool SdlWindow::handle(const SDL_Event& event) {
  if (event.type == SDL_QUIT) return false;
  if (event.type == SDL_WINDOWEVENT) {
    const auto what = event.window.event;
    if (what == SDL_WINDOWEVENT_CLOSE) return false;
    // A fault is ignored here, since the next show() reports it.
    if (what == SDL_WINDOWEVENT_EXPOSED || what == SDL_WINDOWEVENT_SIZE_CHANGED)
      static_cast<void>(draw().ok());
  }
  if (form_.input) act(event);
  return true;
}

std::vector<std::string> SdlWindow::takeCommands() {
  std::vector<std::string> all;
  const Timestamp now = SystemClock().now();
  while (const auto told = panel_.take(now)) all.push_back("operator_pointer " + *told);
  for (std::string& command : commands_.take()) all.push_back(std::move(command));
  return all;
}

// Returns whether the operator's panel takes the event. SDL reports a finger on the screen as the
// left button of a mouse; the finger leaves with its release.
bool SdlWindow::pointOnPanel(const SDL_Event& event) {
  if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_LEAVE) panel_.leave();
  const bool moves = event.type == SDL_MOUSEMOTION;
  const bool presses = event.type == SDL_MOUSEBUTTONDOWN,
             releases = event.type == SDL_MOUSEBUTTONUP;
  const bool left = (presses || releases) && event.button.button == SDL_BUTTON_LEFT;
  const bool drags_otherwise =
      moves && event.motion.state != 0 && (event.motion.state & SDL_BUTTON_LMASK) == 0;
  if ((!moves && !left) || drags_otherwise || drawn_.width == 0) return false;
  const PixelSize picture{form_.picture_width, form_.picture_height};
  const PixelRectangle at = fit(picture, drawn_, form_.fit != 0);
  const int x = moves ? event.motion.x : event.button.x,
            y = moves ? event.motion.y : event.button.y;
  const bool pressed = moves ? (event.motion.state & SDL_BUTTON_LMASK) != 0 : presses;
  const bool taken = panel_.point((x - at.x) * picture.width / at.width,
                                  (y - at.y) * picture.height / at.height, pressed);
  if (releases && event.button.which == SDL_TOUCH_MOUSEID) panel_.leave();
  return taken;
}

void SdlWindow::act(const SDL_Event& event) {
  if (pointOnPanel(event)) return;
  int width = 0, height = 0;
  SDL_GetWindowSize(window_.get(), &width, &height);
  if (event.type == SDL_MOUSEMOTION && event.motion.state != 0) {
    const bool turns =
        event.motion.state == SDL_BUTTON_LMASK && (SDL_GetModState() & KMOD_SHIFT) == 0;
    commands_.drag(turns ? WindowCommands::Drag::kTurn : WindowCommands::Drag::kShift,
                   event.motion.xrel, event.motion.yrel, height);
  }
  if (event.type == SDL_MOUSEWHEEL) {
    const double notches = static_cast<double>(event.wheel.preciseY);
    commands_.wheel(event.wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -notches : notches);
  }
  if (event.type == SDL_KEYDOWN) press(event.key);
}

void SdlWindow::press(const SDL_KeyboardEvent& event) {
  const int with = event.keysym.mod;
  if ((with & (KMOD_ALT | KMOD_GUI)) != 0) return;  // a shortcut of the desktop
  const bool repeats = event.repeat != 0;
  if (event.keysym.sym == SDLK_F11) {
    if (!repeats) toggleFullscreen();
    return;
  }
  commands_.press({SDL_GetKeyName(event.keysym.sym), (with & KMOD_SHIFT) != 0,
                   (with & KMOD_CTRL) != 0, repeats});
}

void SdlWindow::toggleFullscreen() {
  form_.fullscreen = form_.fullscreen ? 0 : 1;
  SDL_SetWindowFullscreen(window_.get(), form_.fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
  SDL_Rect monitor;
  if (SDL_GetDisplayBounds(form_.monitor, &monitor) != 0) return;
  const SDL_Rect at = placeOf(form_, monitor);
  SDL_SetWindowSize(window_.get(), at.w, at.h);
  SDL_SetWindowPosition(window_.get(), at.x, at.y);
}

}  // namespace merlin::render::out
