#include "tests/bench/soak/virtual_devices.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "daemon/devices/device_places.h"
#include "drivers/io/recording_stream.h"
#include "drivers/registry.h"
#include "tests/bench/figures.h"

namespace merlin::bench {

class VirtualStream final : public ByteStream {
 public:
  explicit VirtualStream(VirtualLine& line) : line_(line), plugged_(line.plugged_) {}

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    const Timestamp deadline = line_.fibers_.now() + timeout;
    for (;;) {
      const Timestamp now = line_.fibers_.now();
      if (isClosed()) return Error{Errc::kClosed, "the adapter was unplugged"};
      if (line_.emulator_) line_.emulator_->advance(now, line_.input_);
      if (!line_.input_.empty()) break;
      if (now >= deadline) return Error{Errc::kTimeout, "nothing came"};
      const Timestamp due = line_.emulator_ ? line_.emulator_->nextDue() : deadline;
      line_.fibers_.waitUntil(std::clamp(due, now + std::chrono::microseconds(1), deadline));
    }
    const std::size_t n = std::min(buffer.size(), line_.input_.size());
    std::memcpy(buffer.data(), line_.input_.data(), n);
    line_.input_.erase(0, n);
    return n;
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration) override {
    if (isClosed()) return Error{Errc::kClosed, "the adapter was unplugged"};
    if (line_.emulator_) line_.emulator_->receive(bytes, line_.fibers_.now());
    return bytes.size();
  }
  void interrupt() noexcept override { interrupted_ = true; }

 private:
  bool isClosed() const { return interrupted_ || line_.plugged_ != plugged_; }

  VirtualLine& line_;
  std::uint64_t plugged_;
  bool interrupted_ = false;
};

Result<std::unique_ptr<ByteStream>> VirtualLine::open() {
  if (plugged_ % 2 == 0) return Error{Errc::kClosed, "the adapter is not there"};
  input_.clear();
  return std::unique_ptr<ByteStream>(std::make_unique<VirtualStream>(*this));
}

void VirtualLine::plug(bool in) {
  if ((plugged_ % 2 == 1) == in) return;
  ++plugged_;
}

VirtualDevices::VirtualDevices(const Settings& settings, std::vector<Line> lines, Fibers& fibers,
                               Clock& clock)
    : fibers_(fibers), clock_(clock), lines_(std::move(lines)) {
  const std::uint64_t generation = 1;
  auto segment = shm::SegmentWriter<shm::DevicesSegment>::make(
      shm::segmentName(settings.instance, "devices"),
      shm::devicesFields(devices::slotNames(settings.devices)), generation, clock.now(), {});
  if (!segment) didNotRun("shared memory", segment.error().what, "see /dev/shm");
  segment_.emplace(*std::move(segment));
  auto slots = shm::DeviceSlots::find(**segment_);
  if (!slots) didNotRun("shared memory", slots.error().what, "fix the benchmark");
  slots_ = *std::move(slots);
  flight_.emplace(**segment_, settings.run_directory + "/flight", settings.instance);
  const auto trained = devices::loadTrained(settings);
  if (!trained) didNotRun("the postures", trained.error().what, "run it in a source tree");
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const DeviceSettings& device = settings.devices.list[i];
    chains_.push_back(std::make_unique<devices::DeviceChain>(settings.devices, i, *trained,
                                                             generation, **segment_));
    ByteTap& tap = flight_->ringOf(i, device.name, device.line.driver, device.line.baud);
    DeviceLoopSettings loop;
    loop.port = device.line.port;
    loop.baud = device.line.baud;
    const auto open = [this, i, &tap]() -> Result<std::unique_ptr<ByteStream>> {
      auto stream = lines_[i].line->open();
      if (!stream) return stream;
      return std::unique_ptr<ByteStream>(
          std::make_unique<io::RecordingStream>(*std::move(stream), tap, clock_));
    };
    loops_.push_back(std::make_unique<DeviceLoop>(
        loop, open, findDriver(device.line.driver)->make(device.own, clock_, chains_[i]->samples()),
        chains_[i]->health(), clock_));
  }
}

void VirtualDevices::start(const std::stop_token& stop) {
  for (const auto& loop : loops_) {
    DeviceLoop* const running = loop.get();
    fibers_.start([running, stop] { running->run(stop); });
  }
}

void VirtualDevices::reload(const Settings& settings, bool bindings, bool hand, bool postures) {
  const auto trained = devices::loadTrained(settings);
  for (const auto& chain : chains_) {
    if (bindings) chain->rebind(settings.devices);
    if (hand) chain->reloadHands(settings.devices);
    if (postures && trained) chain->reloadPostures(*trained, settings.devices);
  }
}

std::uint64_t VirtualDevices::samples() const {
  std::uint64_t sum = 0;
  for (const auto& health : slots_->health) {
    if (const auto now = health.slot->read()) sum += now->samples;
  }
  return sum;
}

}  // namespace merlin::bench
