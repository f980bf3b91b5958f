#include "daemon/cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/base/log.h"

namespace merlin::cli {
namespace {

constexpr Duration kProgressRedraw = std::chrono::milliseconds(100);
constexpr int kProgressWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::string title, std::string unit, const Clock& clock)
    : title_(std::move(title)),
      unit_(std::move(unit)),
      clock_(clock),
      terminal_(::isatty(STDERR_FILENO) == 1),
      began_(clock.now()) {}

void ProgressBar::update(double share, std::size_t count) {
  const Timestamp now = clock_.now();
  if (terminal_) {
    if (now - drawn_ < kProgressRedraw) return;
    drawn_ = now;
    draw(share, count);
  } else if (static_cast<int>(10 * share) > tenths_) {
    tenths_ = static_cast<int>(10 * share);
    draw(share, count);
  }
}

void ProgressBar::finish(std::size_t count) {
  if (terminal_ || tenths_ < 10) draw(1, count);
  if (terminal_) printError("\n");
}

void ProgressBar::draw(double share, std::size_t count) {
  const double seconds = toSeconds(clock_.now() - began_);
  const double rate = seconds > 0 ? static_cast<double>(count) / seconds : 0;
  const double left = share > 0 ? seconds * (1 - share) / share : 0;
  const int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * kProgressWidth);
  printError("{}{} [{:#<{}}{:.<{}}] {:3.0f} %  {:.0f} {}/s  {:.1f} s left{}", terminal_ ? "\r" : "",
             title_, "", full, "", kProgressWidth - full, 100 * share, rate, unit_, left,
             terminal_ ? "  " : "\n");
  std::fflush(stderr);
}

}  // namespace merlin::cli
