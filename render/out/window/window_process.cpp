#include "render/out/window/window_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/child_process.h"

namespace merlin::render::out {
namespace {

// The program gets its socket as standard input and the pictures as standard output, no signal
// blocked or ignored, and nothing else that is open here. Returns 0 or the number of the error.
int spawn(pid_t& pid, const std::string& program, int socket, int pictures) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, socket, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, pictures, STDOUT_FILENO);
  ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawnattr_t how;
  ::posix_spawnattr_init(&how);
  sigset_t none, all;
  ::sigemptyset(&none);
  ::sigfillset(&all);
  ::posix_spawnattr_setsigmask(&how, &none);
  ::posix_spawnattr_setsigdefault(&how, &all);
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  char* const argv[] = {const_cast<char*>(program.c_str()), nullptr};
  const int refused = ::posix_spawn(&pid, program.c_str(), &files, &how, argv, environ);
  ::posix_spawnattr_destroy(&how);
  ::posix_spawn_file_actions_destroy(&files);
  return refused;
}

}  // namespace

Result<std::string> windowProgram() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto program = self.parent_path() / "merlin-window";
  if (!error && ::access(program.c_str(), X_OK) == 0) return program.string();
  return Error{Errc::kUnsupported,
               fmt::format("this build has no window output: {} is not there; build MERLIN where "
                           "SDL2 is installed (Debian: libsdl2-dev)",
                           program.string())};
}

Result<std::unique_ptr<WindowProcess>> WindowProcess::start(const std::string& program,
                                                            const WindowForm& form, int pictures) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return Error{Errc::kIo,
                 fmt::format("a socket to merlin-window cannot be made: {}", std::strerror(errno))};
  UniqueFd ours(ends[0]), theirs(ends[1]);
  if (::send(ours.get(), &form, sizeof form, MSG_NOSIGNAL) != sizeof form)
    return Error{Errc::kIo, fmt::format("merlin-window cannot be told the window's size: {}",
                                        std::strerror(errno))};
  pid_t pid = -1;
  if (const int refused = spawn(pid, program, theirs.get(), pictures); refused != 0)
    return Error{Errc::kIo,
                 fmt::format("{} cannot be started: {}", program, std::strerror(refused))};
  return std::unique_ptr<WindowProcess>(new WindowProcess(pid, std::move(ours)));
}

// Killed rather than asked, since it may wait for an X server that does not answer. The X server
// removes the window.
WindowProcess::~WindowProcess() {
  ::kill(pid_, SIGKILL);
  waitForChild(pid_);
}

Result<Ok> WindowProcess::send(const FrameReady& frame) {
  if (::send(socket_.get(), &frame, sizeof frame, MSG_NOSIGNAL | MSG_DONTWAIT) == sizeof frame)
    return Ok{};
  return Error{Errc::kClosed, "its program merlin-window has ended"};
}

Result<std::optional<WindowEvent>> WindowProcess::receive() {
  WindowEvent event;
  const ssize_t n = ::recv(socket_.get(), &event, sizeof event, MSG_DONTWAIT);
  if (n == static_cast<ssize_t>(sizeof event)) return std::optional(event);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return std::optional<WindowEvent>();
  return Error{Errc::kClosed, "its program merlin-window has ended"};
}

}  // namespace merlin::render::out
