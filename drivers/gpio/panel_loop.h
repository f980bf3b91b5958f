// PanelLoop: keeps the panel's chip open and its lines as the panel wants them; the body of the
// GPIO thread.
#pragma once

#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "drivers/gpio/panel.h"
#include "drivers/port/gpio_line.h"
#include "drivers/port/sample_sink.h"

namespace merlin::gpio {

// Where the panel's state goes.
using GpioSink = std::function<void(const GpioSample&)>;

class PanelLoop {
 public:
  // `on_press` is called on the loop's thread when the button was pressed.
  PanelLoop(const GpioSettings& settings, GpioOpener open, GpioSink sink, HealthSink& health,
            Clock& clock, std::function<void()> on_press);

  // Until `stop`, then everything off but the projectors: they keep what they have. `alive` is
  // called several times a second.
  void run(
      const std::stop_token& stop, const std::function<void()>& alive = [] {});

  // As Panel::obey, from any thread; is seen by the lines within 50 ms. kIo while the chip is lost.
  Result<Ok> obey(const std::string& command);

 private:
  Error serve(const std::stop_token& stop, const std::function<void()>& alive);
  Result<Ok> apply(GpioLines& lines);
  void report(HealthState state, const std::string& reason);

  GpioSettings settings_;
  GpioOpener open_;
  GpioSink sink_;
  HealthSink& health_sink_;
  Clock& clock_;
  std::function<void()> on_press_;
  std::mutex mutex_;  // of panel_ and lost_; no device thread takes it
  Panel panel_;
  std::string lost_ = "the panel's chip is not open yet";
  DeviceHealth health_{};
  bool fresh_ = true;  // the lines have not been written since the chip was opened
  Outputs written_;
};

}  // namespace merlin::gpio
