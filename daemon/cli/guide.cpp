#include "daemon/cli/guide.h"

#include <cstdio>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/log.h"
#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

// Number of attempts at a step, after which the calibration ends even if nobody takes part.
constexpr int kMostTriesOfAStep = 5;
constexpr Duration kGuideRedraw = std::chrono::milliseconds(100);

bool enterPressed() {
  pollfd item{STDIN_FILENO, POLLIN, 0};
  char line[256];
  return ::poll(&item, 1, 0) > 0 && ::read(STDIN_FILENO, line, sizeof line) >= 0;
}

// Shows Guided::now() on one line of the terminal, redrawn in place; shows nothing if stderr is not
// a terminal.
class LiveLine {
 public:
  LiveLine() = default;
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;
  ~LiveLine() {
    if (drawn_ != Timestamp{}) printError("\r\033[K");
  }
  void draw(const Guided& guided, Timestamp now) {
    if (!terminal_ || now - drawn_ < kGuideRedraw) return;
    const std::string line = guided.now();
    if (line.empty()) return;
    drawn_ = now;
    printError("\r\033[K  {}", line);
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) == 1;
  Timestamp drawn_{};
};

// Calls guided.listen() until `until()` returns true or listen() fails; shows the current values
// meanwhile.
template <typename Until>
Result<Ok> listenUntil(Guided& guided, const Clock& clock, bool measuring, Until until) {
  LiveLine live;
  while (!until()) {
    if (auto heard = guided.listen(measuring); !heard) return heard;
    live.draw(guided, clock.now());
  }
  return Ok{};
}

// Measures a step once and returns the result of end(). `broken` is set to the result of listen();
// an error of it ends the calibration.
Result<std::string> tryStep(std::size_t step, const GuideTiming& timing, Guided& guided,
                            Result<Ok>& broken) {
  const SystemClock clock;
  const Timestamp ready = clock.now() + fromSeconds(timing.pause_s);
  broken = listenUntil(guided, clock, false,
                       [&] { return timing.pause_s > 0 ? clock.now() >= ready : enterPressed(); });
  // Discards samples that were sent before Enter was pressed.
  if (broken) broken = guided.listen(false);
  if (!broken) return broken.error();
  guided.begin(step);
  const Timestamp end = clock.now() + fromSeconds(timing.hold_s);
  broken = listenUntil(guided, clock, true, [&] { return clock.now() >= end; });
  if (!broken) return broken.error();
  return guided.end();
}

}  // namespace

void addGuideTiming(Command app, GuideTiming& timing) {
  app.option("--hold", timing.hold_s, "Duration of the measurement of each step, in seconds")
      .range(0.1, 60.0)
      .showDefault();
  app.option("--pause", timing.pause_s,
             "Start the measurement of a step after this time, in seconds, instead of waiting for "
             "Enter")
      .range(0.1, 600.0);
}

Result<Ok> guide(std::span<const GuidedStep> steps, const GuideTiming& timing, Guided& guided) {
  for (std::size_t step = 0; step < steps.size(); ++step) {
    for (int tries = 1;; ++tries) {
      printOut("\n{}: {}{}\n", steps[step].name, steps[step].instruction,
               timing.pause_s > 0 ? "" : "; then press Enter");
      std::fflush(stdout);
      Result<Ok> broken = Ok{};
      const auto measured = tryStep(step, timing, guided, broken);
      if (!broken) return broken;
      printOut("  {}\n", measured ? *measured : "again: " + measured.error().what);
      std::fflush(stdout);
      if (measured) break;
      if (tries == kMostTriesOfAStep) {
        return Error{measured.error().code,
                     fmt::format("{}: refused {} times, the last time because {}; nothing was "
                                 "changed",
                                 steps[step].name, kMostTriesOfAStep, measured.error().what)};
      }
    }
  }
  return Ok{};
}

}  // namespace merlin::cli
