// Emulated devices on virtual lines, and what merlind's role devices does with them. Except for the
// threads, everything is the product's own code: loops, drivers, chains, flight recorder and shared
// memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/devices/device_chain.h"
#include "daemon/devices/flight_recorder.h"
#include "daemon/shm/segment.h"
#include "drivers/emulate/emulator.h"
#include "drivers/loop/device_loop.h"
#include "tests/bench/soak/virtual_time.h"

namespace merlin::bench {

// A device at the end of a line, and the faults that the script causes at both. Thread-bound.
class VirtualLine {
 public:
  using Maker = std::function<std::unique_ptr<emulate::Emulator>(Timestamp start)>;
  VirtualLine(Fibers& fibers, Maker make) : fibers_(fibers), make_(std::move(make)) { power(true); }

  // Opens the port. Errors: kClosed while unplugged.
  Result<std::unique_ptr<ByteStream>> open();

  // Plugs the adapter in, or unplugs it, which closes open streams.
  void plug(bool in);
  // Switches the device off, or on again; it then starts anew. The line remains plugged in.
  void power(bool on) { emulator_ = on ? make_(fibers_.now()) : nullptr; }
  // Inserts bytes that no device has sent, as a bad contact does.
  void disturb(const std::string& bytes) { input_ += bytes; }

 private:
  friend class VirtualStream;
  Fibers& fibers_;
  Maker make_;
  std::unique_ptr<emulate::Emulator> emulator_;  // null: switched off
  std::string input_;
  // incremented at each change; odd while plugged in. A stream is valid for one value.
  std::uint64_t plugged_ = 1;
};

// The devices of merlind's role devices. Thread-bound.
class VirtualDevices {
 public:
  struct Line {
    std::string name;
    std::unique_ptr<VirtualLine> line;
  };
  // `lines`: one for each device of the settings. Ends the benchmark if merlind would not start
  // with these settings.
  VirtualDevices(const Settings& settings, std::vector<Line> lines, Fibers& fibers, Clock& clock);

  // Starts a fiber for each device.
  void start(const std::stop_token& stop);

  // Applies a reload as merlind's role devices does, except for changes of lines; each flag says
  // whether that part of the settings changed.
  void reload(const Settings& settings, bool bindings, bool hand, bool postures);

  VirtualLine& line(std::size_t device) { return *lines_[device].line; }
  std::size_t count() const { return lines_.size(); }
  const std::string& name(std::size_t device) const { return lines_[device].name; }
  shm::SegmentWriter<shm::DevicesSegment>& segment() { return *segment_; }
  const shm::DeviceSlots& slots() const { return *slots_; }
  devices::FlightRecorder& flight() { return *flight_; }
  // Returns the number of samples of all devices so far.
  std::uint64_t samples() const;

 private:
  Fibers& fibers_;
  Clock& clock_;
  std::vector<Line> lines_;
  std::optional<shm::SegmentWriter<shm::DevicesSegment>> segment_;
  std::optional<shm::DeviceSlots> slots_;
  std::optional<devices::FlightRecorder> flight_;
  std::vector<std::unique_ptr<devices::DeviceChain>> chains_;
  std::vector<std::unique_ptr<DeviceLoop>> loops_;
};

}  // namespace merlin::bench
