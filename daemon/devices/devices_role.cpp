#include "daemon/devices/devices_role.h"

#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include "daemon/base/log.h"
#include "daemon/shm/fields.h"
#include "drivers/io/cpu_latency.h"
#include "drivers/io/gpio_chip.h"
#include "drivers/io/low_latency.h"
#include "drivers/io/open_stream.h"
#include "drivers/io/recording_stream.h"
#include "nn/io/network_file.h"

namespace merlin::devices {
namespace {

constexpr int kRealTimePriority = 50;
// That a device's thread may wait for its line to open.
constexpr Duration kPatience = std::chrono::seconds(60);
constexpr const char* kThreadNames[] = {"glove", "tracker", "ball"};

// Wire to shared memory within microseconds even while the wall draws, where the unit allows it.
void askForRealTime() {
  const sched_param priority{kRealTimePriority};
  if (::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority) != 0) {
    static std::atomic<bool> said{false};
    if (!said.exchange(true))
      logInfo("no real-time priority for device threads (LimitRTPRIO would allow it)");
  }
}

DeviceHealth notConfigured(Timestamp now) {
  DeviceHealth health{};
  health.since_ns = health.updated_ns = toNanoseconds(now);
  health.state = HealthState::kAbsent;
  constexpr std::string_view kReason = "not configured";
  std::copy(kReason.begin(), kReason.end(), health.reason);
  return health;
}

TrackerFrames framesOf(const FastrakSettings& settings) {
  TrackerFrames frames;  // NOLINT(*-member-init): filled below
  for (std::size_t i = 0; i < kStations; ++i) {
    std::copy(settings.alignment_cm[i].begin(), settings.alignment_cm[i].end(),
              frames.alignment_cm[i]);
    std::copy(settings.boresight_wxyz[i].begin(), settings.boresight_wxyz[i].end(),
              frames.boresight_wxyz[i]);
  }
  return frames;
}

// Opens a line, listened to by the flight recorder; says once what its adapter costs.
class Opener {
 public:
  Opener(io::PortAddress address, int baud, ByteTap& tap, const Clock& clock)
      : address_(std::move(address)), baud_(baud), tap_(tap), clock_(clock) {}

  Result<std::unique_ptr<ByteStream>> operator()() {
    auto stream = io::openPort(address_, baud_);
    if (!stream) return stream;
    if (std::string warning = io::adapterWarning(address_.path); warning != warned_) {
      warned_ = std::move(warning);
      if (!warned_.empty()) logWarning("{}", warned_);
    }
    return std::unique_ptr<ByteStream>(
        std::make_unique<io::RecordingStream>(*std::move(stream), tap_, clock_));
  }

 private:
  io::PortAddress address_;
  int baud_;
  ByteTap& tap_;
  const Clock& clock_;
  std::string warned_;
};

}  // namespace

DevicesRole::DevicesRole(shm::SegmentWriter<shm::DevicesSegment> segment, std::string flight_folder,
                         Clock& clock)
    : segment_(std::move(segment)),
      clock_(clock),
      sink_(*segment_),
      flight_(*segment_, std::move(flight_folder)) {}

Result<std::unique_ptr<DevicesRole>> DevicesRole::make(const Settings& settings,
                                                       std::uint64_t generation,
                                                       const shm::Endpoints& endpoints,
                                                       Clock& clock) {
  auto segment = shm::SegmentWriter<shm::DevicesSegment>::make(
      shm::segmentName(settings.instance, "devices"), shm::devicesFields(), generation, clock.now(),
      endpoints);
  if (!segment) return segment.error();
  std::unique_ptr<DevicesRole> role(
      new DevicesRole(*std::move(segment), settings.run_directory + "/flight", clock));
  if (!settings.devices.postures.empty()) {
    const auto file = nn::loadNetwork(settings.devices.postures);
    if (!file) return file.error();
    role->posture_sink_ = std::make_unique<PostureSink>(
        file->network, settings.devices.posture_hold,
        PostureSink::Outputs{role->segment_->posture, role->segment_->posture_state}, role->sink_);
  }
  role->hand_sink_ =
      std::make_unique<HandSink>(settings.devices.hand, *role->segment_, role->sink_);
  role->addPanel(settings.devices.gpio);
  role->cpu_latency_us_ = settings.devices.cpu_latency_us;
  role->segment_->tracker_frames.publish(framesOf(settings.devices.tracker));
  const DevicesSettings& d = settings.devices;
  const std::pair<const LineSettings*, std::pair<SampleKind, shm::DeviceIndex>> kLines[] = {
      {&d.glove_line, {SampleKind::kGlove, shm::kGlove}},
      {&d.tracker_line, {SampleKind::kTracker, shm::kTracker}},
      {&d.ball_line, {SampleKind::kBall, shm::kBall}}};
  for (const auto& [line, what] : kLines) {
    if (const auto added = role->add(*line, what.first, what.second, settings); !added)
      return added.error();
  }
  return role;
}

Result<Ok> DevicesRole::add(const LineSettings& line, SampleKind kind, shm::DeviceIndex index,
                            const Settings& settings) {
  shm::SeqSlot<DeviceHealth>& slot = segment_->health[index];
  slot.publish(notConfigured(clock_.now()));
  if (line.port.empty()) return Ok{};
  const DriverEntry* driver = findDriver(kind, line.driver);
  if (!driver) return Error{Errc::kInvalidArgument, "no driver is named " + line.driver};
  const auto address = io::parsePort(line.port);
  if (!address) return address.error();
  const DriverSettings own{settings.devices.glove, settings.devices.tracker, settings.devices.ball};
  SampleSink* sink = &sink_;
  if (kind == SampleKind::kGlove && posture_sink_) sink = posture_sink_.get();
  if (kind == SampleKind::kTracker) sink = hand_sink_.get();
  started_.push_back(index);
  health_.push_back(std::make_unique<shm::ShmHealthSink>(slot));
  DeviceLoopSettings loop;
  loop.port = line.port;
  loop.baud = line.baud;
  ByteTap& tap = flight_.add(index, line.driver, line.baud);
  loops_.push_back(std::make_unique<DeviceLoop>(loop, Opener(*address, line.baud, tap, clock_),
                                                driver->make(own, clock_, *sink), *health_.back(),
                                                clock_));
  return Ok{};
}

void DevicesRole::addPanel(const GpioSettings& settings) {
  segment_->gpio_health.publish(notConfigured(clock_.now()));
  if (settings.chip.empty()) return;
  health_.push_back(std::make_unique<shm::ShmHealthSink>(segment_->gpio_health));
  const auto open = [settings] {
    return io::openGpioChip(settings.chip,
                            {settings.projector_line, settings.video_line, settings.lamp_line},
                            settings.button_line);
  };
  const auto publish = [this](const GpioSample& sample) {
    const auto last = segment_->gpio.newest();
    if (!last || last->counter != sample.counter || last->wait_s != sample.wait_s)
      segment_->gpio.publish(sample);
  };
  panel_ =
      std::make_unique<gpio::PanelLoop>(settings, open, publish, *health_.back(), clock_,
                                        [this](const std::string& command) { on_press_(command); });
}

void DevicesRole::start(ThreadWatch& watch) {
  if (cpu_latency_us_ >= 0) {
    if (auto limit = io::limitCpuLatency(cpu_latency_us_))
      cpu_latency_ = *std::move(limit);
    else
      logWarning("/devices/cpu_latency_us: {}", limit.error().what);
  }
  if (panel_) {
    threads_.emplace_back(watch, "panel",
                          [this](const std::stop_token& stop, Progress&) { panel_->run(stop); });
  }
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    threads_.emplace_back(watch, kThreadNames[started_[i]],
                          [&loop = *loops_[i]](const std::stop_token& stop, Progress&) {
                            askForRealTime();
                            loop.run(stop);
                          });
  }
}

std::vector<std::uint64_t> DevicesRole::progress(Timestamp now) const {
  std::vector<std::uint64_t> counters;
  for (const shm::DeviceIndex device : started_) {
    const auto health = segment_->health[device].read();
    const Timestamp last = health ? fromNanoseconds(health->updated_ns) : Timestamp{};
    counters.push_back(
        static_cast<std::uint64_t>(toNanoseconds(now - last < kPatience ? now : last)));
  }
  return counters;
}

DevicesRole::~DevicesRole() {
  for (WatchedThread& thread : threads_) thread.requestStop();
  threads_.clear();
}

}  // namespace merlin::devices
