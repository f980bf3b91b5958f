#include "daemon/cli/wall/raw_terminal.h"

#include <csignal>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "daemon/base/printable_text.h"
#include "daemon/cli/stop_signals.h"

namespace merlin::cli {
namespace {

// Escape codes: another screen, no cursor.
constexpr std::string_view kEnter = "\033[?1049h\033[?25l";
constexpr std::string_view kLeave = "\033[?25h\033[?1049l";

// Signals that end the process at once. The signals of stopSignals() are not among them, because
// they arrive through a descriptor.
constexpr int kFatal[] = {SIGQUIT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE};

// These are globals, because the signal handler that restores the terminal has no other access to
// them.
termios terminal_before{};                        // NOLINT
volatile std::sig_atomic_t terminal_changed = 0;  // NOLINT

// Restores the terminal. Async-signal-safe.
void putBack() {
  if (terminal_changed == 0) return;
  terminal_changed = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &terminal_before);
  const auto written = ::write(STDOUT_FILENO, kLeave.data(), kLeave.size());
  static_cast<void>(written);  // an error is ignored: the terminal is gone then
}

void onFatal(int signal) {
  putBack();
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void write(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace

Result<Ok> RawTerminal::check() {
  if (::isatty(STDIN_FILENO) == 1 && ::isatty(STDOUT_FILENO) == 1) return Ok{};
  return Error{
      Errc::kUnsupported,
      "standard input or output is not a terminal; run this in a terminal, without redirection"};
}

RawTerminal::RawTerminal() : signals_(stopSignals()) {
  ::tcgetattr(STDIN_FILENO, &terminal_before);
  terminal_changed = 1;
  for (const int s : kFatal) ::signal(s, onFatal);
  termios raw = terminal_before;
  // ISIG is kept, so that Ctrl-C ends the program.
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 1;
  raw.c_cc[VTIME] = 0;
  raw.c_cc[VSUSP] = _POSIX_VDISABLE;
  raw.c_cc[VQUIT] = _POSIX_VDISABLE;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  write(kEnter);
}

RawTerminal::~RawTerminal() {
  std::fflush(stdout);
  putBack();
  for (const int s : kFatal) ::signal(s, SIG_DFL);
}

std::optional<std::string> RawTerminal::read(int timeout_ms) {
  pollfd items[] = {{STDIN_FILENO, POLLIN, 0}, {signals_.get(), POLLIN, 0}};
  if (::poll(items, 2, timeout_ms) <= 0) return std::string();
  if (items[1].revents != 0) return std::nullopt;
  char bytes[256];
  const ssize_t n = ::read(STDIN_FILENO, bytes, sizeof bytes);
  if (n <= 0) return std::nullopt;
  return std::string(bytes, static_cast<std::size_t>(n));
}

void RawTerminal::show(const std::vector<std::string>& lines) {
  std::string text = "\033[H";
  for (const std::string& line : lines) text += fmt::format("{}\033[K\r\n", oneLine(line));
  write(text + "\033[J");
}

}  // namespace merlin::cli
