// WindowProcess: starts merlin-window, exchanges messages with it, and ends it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <sys/types.h>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "render/out/window/messages.h"

namespace merlin::render::out {

// Returns the path of merlin-window, which is in the same folder as this program. Errors:
// kUnsupported (it is not there, since MERLIN was built or installed without SDL2).
Result<std::string> windowProgram();

// Thread-bound; no call waits. If the thread that started it ends, so does the program.
class WindowProcess {
 public:
  // Starts `program` and sends it `form`. `pictures`: descriptor of the PictureSlots. Errors: kIo.
  static Result<std::unique_ptr<WindowProcess>> start(const std::string& program,
                                                      const WindowForm& form, int pictures);
  ~WindowProcess();  // kills the program
  WindowProcess(const WindowProcess&) = delete;
  WindowProcess& operator=(const WindowProcess&) = delete;

  // Returns the socket's descriptor, which is readable when there is an event or the program has
  // ended.
  int socket() const noexcept { return socket_.get(); }

  // Announces a frame to the program. Errors: kClosed (the program has ended, or does not read its
  // messages).
  Result<Ok> send(const FrameReady& frame);

  // Returns the next event; nothing if there is none now. Errors: kClosed (the program has ended).
  Result<std::optional<WindowEvent>> receive();

 private:
  WindowProcess(pid_t pid, UniqueFd socket) : pid_(pid), socket_(std::move(socket)) {}

  pid_t pid_;
  UniqueFd socket_;
};

}  // namespace merlin::render::out
