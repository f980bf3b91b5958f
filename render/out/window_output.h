// WindowOutput: shows frames in a window on a desktop (render/out/window).
#pragma once

#include <string>

#include "render/out/output.h"
#include "render/out/window/window_link.h"

namespace merlin::render::out {

class WindowOutput final : public Output {
 public:
  // The parameters are those of WindowLink.
  WindowOutput(const WindowSettings& settings, const WindowActs& acts, const std::string& program,
               ThreadWatch& watch, const Clock& clock)
      : link_(settings, acts, program, watch, clock), clock_(clock) {}

  bool mayTake(const FrameInfo&) const override { return !link_.isClosed(); }

  // A frame counts as shown when it is handed over, unless it takes the place of a frame that the
  // window has not fetched yet.
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo&) override {
    const auto shown = link_.show(signal.width, signal.height, signal.pixels);
    if (!shown) return shown.error();
    return *shown ? std::optional(clock_.now()) : std::nullopt;
  }

  std::optional<std::string> faultNow() const override { return link_.fault(); }

 private:
  WindowLink link_;
  const Clock& clock_;
};

}  // namespace merlin::render::out
