// merlin-window: the window of an output of kind window. merlind starts it; see README.md.
#include <csignal>
#include <cstdio>
#include <span>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "render/out/window/picture_slots.h"
#include "render/out/window/sdl_window.h"

namespace merlin::render::out {
namespace {

// Longest time until a key or a motion is handled while no frame comes.
constexpr int kEventStep_ms = 8;

void send(int socket, WindowEvent::Kind kind, std::string_view text = {}) {
  WindowEvent event;
  event.kind = kind;
  copyText(text, event.text);
  static_cast<void>(::send(socket, &event, sizeof event, MSG_NOSIGNAL));
}

// Moves merlind's socket and the pictures away from standard input and output, which libraries may
// use.
struct Inherited {
  UniqueFd socket{::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)};
  UniqueFd pictures{::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)};
};

void leaveStandardStreams() {
  const UniqueFd nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
  ::dup2(nothing.get(), STDIN_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

// Shows the frame that merlind has announced, if any. Returns false if merlind has ended or the
// frame cannot be shown.
bool showAnnounced(int socket, SdlWindow& window, const PictureSlots& pictures) {
  FrameReady frame;
  const ssize_t n = ::recv(socket, &frame, sizeof frame, MSG_DONTWAIT);
  if (n == 0) return false;
  if (n != static_cast<ssize_t>(sizeof frame) || frame.slot >= PictureSlots::kCount) return true;
  const auto shown = window.show(pictures.slot(frame.slot));
  if (shown)
    send(socket, WindowEvent::kShown);
  else
    send(socket, WindowEvent::kFault, shown.error().what);
  return shown.ok();
}

int serve(int socket, SdlWindow& window, const PictureSlots& pictures) {
  send(socket, WindowEvent::kOpened);
  for (;;) {
    pollfd fd{socket, POLLIN, 0};
    ::poll(&fd, 1, kEventStep_ms);
    if (fd.revents != 0 && !showAnnounced(socket, window, pictures)) return 0;
    if (!window.handleEvents()) {
      send(socket, WindowEvent::kClosed);
      return 0;
    }
    for (const std::string& command : window.takeCommands())
      send(socket, WindowEvent::kCommand, command);
  }
}

int run() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // the window ends with its output, whatever it waits for
  Inherited inherited;
  WindowForm form;
  const int socket = inherited.socket.get();
  const ssize_t n = ::recv(socket, &form, sizeof form, MSG_DONTWAIT);
  if (n != static_cast<ssize_t>(sizeof form) || form.magic != kWindowMagic) {
    std::fputs(
        "merlin-window: merlind of the same release starts this program, for outputs of kind "
        "window\n",
        stderr);
    return 2;
  }
  leaveStandardStreams();
  const auto pictures =
      PictureSlots::open(std::move(inherited.pictures), form.picture_width, form.picture_height);
  if (!pictures) {
    send(socket, WindowEvent::kFault, pictures.error().what);
    return 1;
  }
  const auto window = SdlWindow::open(form);
  if (!window) {
    send(socket, WindowEvent::kFault, window.error().what);
    return 1;
  }
  return serve(socket, **window, *pictures);
}

}  // namespace
}  // namespace merlin::render::out

int main() { return merlin::render::out::run(); }
