#include "drivers/gpio/panel_loop.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "drivers/port/health_reasons.h"

namespace merlin::gpio {
namespace {

constexpr Duration kRound = std::chrono::milliseconds(50);
constexpr Duration kRetry = std::chrono::milliseconds(500);

template <std::size_t N>
void setText(char (&field)[N], const std::string& text) {
  const std::size_t n = std::min(text.size(), N - 1);
  std::memcpy(field, text.data(), n);
  field[n] = '\0';
}

}  // namespace

PanelLoop::PanelLoop(const GpioSettings& settings, GpioOpener open, GpioSink sink,
                     HealthSink& health, Clock& clock, std::function<void()> on_press)
    : settings_(settings),
      open_(std::move(open)),
      sink_(std::move(sink)),
      health_sink_(health),
      clock_(clock),
      on_press_(std::move(on_press)),
      panel_(settings, clock.now()) {
  setText(health_.port, settings.chip);
}

void PanelLoop::run(const std::stop_token& stop, const std::function<void()>& alive) {
  while (!stop.stop_requested()) {
    alive();
    const Error end = serve(stop, alive);
    if (stop.stop_requested()) break;
    {
      const std::lock_guard lock(mutex_);
      lost_ = end.what;
    }
    report(end.code == Errc::kNotFound ? HealthState::kAbsent : HealthState::kFailed, end.what);
    if (!clock_.sleepUntil(clock_.now() + kRetry, stop)) break;
  }
  report(HealthState::kAbsent, std::string(kStopped));
}

Error PanelLoop::serve(const std::stop_token& stop, const std::function<void()>& alive) {
  auto lines = open_();
  if (!lines) return lines.error();
  {
    const std::lock_guard lock(mutex_);
    lost_.clear();
  }
  fresh_ = true;
  report(HealthState::kOk, "");
  while (!stop.stop_requested()) {
    alive();
    const auto pressed = (*lines)->read(settings_.button_line);
    if (!pressed) return pressed.error();
    bool press = false;
    Timestamp due;
    {
      const std::lock_guard lock(mutex_);
      press = panel_.step(*pressed, clock_.now());
      due = panel_.nextDue(clock_.now());
    }
    if (press) on_press_();
    if (const auto applied = apply(**lines); !applied) return applied.error();
    report(HealthState::kOk, "");
    const Duration wait = std::clamp<Duration>(due - clock_.now(), Duration::zero(), kRound);
    if (const auto waited = (*lines)->wait(wait); !waited) return waited.error();
  }
  return {Errc::kClosed, std::string(kStopped)};
}

Result<Ok> PanelLoop::apply(GpioLines& lines) {
  Outputs wanted;
  GpioSample sample{};
  {
    const std::lock_guard lock(mutex_);
    wanted = panel_.outputs(clock_.now());
    sample = panel_.sample(clock_.now());
  }
  sink_(sample);
  if (!fresh_ && wanted == written_) return Ok{};
  const std::pair<int, bool> levels[] = {{settings_.projector_line, wanted.projector},
                                         {settings_.video_line, wanted.video},
                                         {settings_.lamp_line, wanted.lamp}};
  for (const auto& [line, high] : levels) {
    if (auto set = lines.write(line, high); !set) return set;
  }
  fresh_ = false;
  written_ = wanted;
  return Ok{};
}

Result<Ok> PanelLoop::execute(const std::string& command) {
  const std::lock_guard lock(mutex_);
  if (!lost_.empty()) return Error{Errc::kIo, lost_};
  return panel_.execute(command, clock_.now());
}

void PanelLoop::warn(bool on) {
  const std::lock_guard lock(mutex_);
  panel_.warn(on, clock_.now());
}

Duration PanelLoop::phaseLeft() {
  const std::lock_guard lock(mutex_);
  return panel_.phaseLeft(clock_.now());
}

void PanelLoop::report(HealthState state, const std::string& reason) {
  const std::int64_t now = toNanoseconds(clock_.now());
  if (state != health_.state || health_.since_ns == 0) health_.since_ns = now;
  health_.state = state;
  health_.updated_ns = now;
  setText(health_.reason, reason);
  health_sink_.publish(health_);
}

}  // namespace merlin::gpio
