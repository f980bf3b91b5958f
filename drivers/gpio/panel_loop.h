// PanelLoop: keeps the GPIO chip open and writes the Panel's outputs to its lines; run() is the
// body of the GPIO thread.
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

// Receives the panel's state; called on the loop's thread.
using GpioSink = std::function<void(const GpioSample&)>;

class PanelLoop {
 public:
  // `on_press` is called on the loop's thread when the button was pressed.
  PanelLoop(const GpioSettings& settings, GpioOpener open, GpioSink sink, HealthSink& health,
            Clock& clock, std::function<void()> on_press);

  // Runs until `stop`. Then it closes the chip, which releases the lines; it does not write them.
  // `alive` is called several times a second.
  void run(
      const std::stop_token& stop, const std::function<void()>& alive = [] {});

  // Executes a command as Panel::execute() does; the lines change within 50 ms. Thread-safe.
  // Errors: those of Panel::execute(), and kIo (the chip is not open).
  Result<Ok> execute(const std::string& command);
  void warn(bool on);    // like Panel::warn(); thread-safe
  Duration phaseLeft();  // like Panel::phaseLeft(); thread-safe

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
  std::mutex mutex_;  // guards panel_ and lost_; no device thread takes it
  Panel panel_;
  std::string lost_ = "the panel's chip is not open yet";
  DeviceHealth health_{};
  bool fresh_ = true;  // no line has been written since the chip was opened
  Outputs written_;
};

}  // namespace merlin::gpio
