#include "daemon/devices/devices_role.h"

#include <atomic>
#include <cassert>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include "daemon/base/fixed_text.h"
#include "daemon/base/log.h"
#include "daemon/shm/fields.h"
#include "drivers/io/cpu_latency.h"
#include "drivers/io/gpio_chip.h"
#include "drivers/io/low_latency.h"
#include "drivers/io/open_stream.h"
#include "drivers/io/recording_stream.h"
#include "drivers/io/tcp_stream.h"
#include "drivers/port/health_reasons.h"

namespace merlin::devices {
namespace {

constexpr int kRealTimePriority = 50;

constexpr double kStreamBytes_s = 1e6;  // limit for a port without a baud rate [bytes/s]
constexpr int kSpare = 4;  // limit for a serial line, as a multiple of what its baud rate allows

double paceOf(const LineSettings& line, const PortAddress& address) {
  if (line.max_bytes_s > 0) return line.max_bytes_s;
  return address.hasSpeed() ? kSpare * line.baud / 10.0 : kStreamBytes_s;
}

// Gives the calling thread real-time priority if the system allows it, so that samples reach shared
// memory within microseconds even while the wall draws. If it does not, this is logged once.
void askForRealTime() {
  const sched_param priority{kRealTimePriority};
  if (::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority) != 0) {
    static std::atomic<bool> said{false};
    if (!said.exchange(true))
      logInfo("no real-time priority for device threads (LimitRTPRIO would allow it)");
  }
}

// Takes real-time priority from the calling thread, because its line sends more bytes than a device
// can. With SCHED_BATCH the thread does not preempt others when it wakes.
void giveUpRealTime() {
  const sched_param none{};
  (void)::pthread_setschedparam(::pthread_self(), SCHED_BATCH, &none);
}

// Returns the health of a device whose thread has not published any yet. `configured`: whether it
// has a port.
DeviceHealth absent(bool configured, Timestamp now) {
  DeviceHealth health{};
  health.since_ns = health.updated_ns = toNanoseconds(now);
  health.state = HealthState::kAbsent;
  setText(health.reason, configured ? kNotOpenedYet : kNotConfigured);
  return health;
}

// Returns the frames of a tracker's stations. Only a Fastrak has settings for them; the samples of
// other trackers are in the frame of their server, so the default values are returned.
TrackerFrames framesOf(const DeviceSettings& device) {
  const FastrakSettings settings =
      device.line.driver == "fastrak" ? device.own.fastrak : FastrakSettings{};
  TrackerFrames frames;  // NOLINT(*-member-init): filled below
  for (std::size_t i = 0; i < kStations; ++i) {
    std::copy(settings.alignment_cm[i].begin(), settings.alignment_cm[i].end(),
              frames.alignment_cm[i]);
    std::copy(settings.boresight_wxyz[i].begin(), settings.boresight_wxyz[i].end(),
              frames.boresight_wxyz[i]);
  }
  return frames;
}

// A stream that counts each read and write as progress of the thread, so that a thread does not
// count as hung during a long dialogue with the device.
class WatchedStream final : public ByteStream {
 public:
  WatchedStream(std::unique_ptr<ByteStream> inner, Progress& progress)
      : inner_(std::move(inner)), progress_(progress) {}

  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    progress_.step();
    return inner_->read(buffer, timeout);
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override {
    progress_.step();
    return inner_->write(bytes, timeout);
  }
  void interrupt() noexcept override { inner_->interrupt(); }

 private:
  std::unique_ptr<ByteStream> inner_;
  Progress& progress_;
};

// Opens a port, and passes a copy of all its bytes to the flight recorder. Logs a warning about a
// slow adapter once, until the warning changes.
class Opener {
 public:
  // `progress`: refers to a pointer that must be set before operator() is called.
  Opener(PortAddress address, int baud, ByteTap& tap, Progress* const& progress, const Clock& clock)
      : address_(std::move(address)), baud_(baud), tap_(tap), progress_(progress), clock_(clock) {}

  Result<std::unique_ptr<ByteStream>> operator()() {
    auto stream = open();
    if (!stream) return stream;
    if (std::string warning = io::adapterWarning(address_.path); warning != warned_) {
      warned_ = std::move(warning);
      if (!warned_.empty()) logWarning("{}", warned_);
    }
    auto watched = std::make_unique<WatchedStream>(*std::move(stream), *progress_);
    return std::unique_ptr<ByteStream>(
        std::make_unique<io::RecordingStream>(std::move(watched), tap_, clock_));
  }

 private:
  Result<std::unique_ptr<ByteStream>> open() {
    const Progress::Pause pause(*progress_);  // looking up a host name may take long
    return io::openPort(address_, baud_);
  }

  PortAddress address_;
  int baud_;
  ByteTap& tap_;
  Progress* const& progress_;
  const Clock& clock_;
  std::string warned_;
};

}  // namespace

DevicesRole::DevicesRole(Memory memory, const Settings& settings, std::uint64_t generation,
                         ThreadWatch& watch, Clock& clock)
    : segment_(std::move(memory.segment)),
      slots_(std::move(memory.slots)),
      watch_(watch),
      clock_(clock),
      flight_(*segment_, settings.run_directory + "/flight", settings.instance),
      generation_(generation) {}

Result<std::unique_ptr<DevicesRole>> DevicesRole::make(const Settings& settings,
                                                       std::uint64_t generation,
                                                       const shm::Endpoints& endpoints,
                                                       ThreadWatch& watch, Clock& clock) {
  auto segment = shm::SegmentWriter<shm::DevicesSegment>::make(
      shm::segmentName(settings.instance, "devices"),
      shm::devicesFields(slotNames(settings.devices)), generation, clock.now(), endpoints);
  if (!segment) return segment.error();
  auto slots = shm::DeviceSlots::find(**segment);
  if (!slots) return slots.error();
  std::unique_ptr<DevicesRole> role(new DevicesRole({*std::move(segment), *std::move(slots)},
                                                    settings, generation, watch, clock));
  if (const auto kept = role->flight_.keepForNextRun(settings.devices.list.size()); !kept)
    logWarning("a crash will leave no flight recordings: {}", kept.error().what);
  const auto trained = loadTrained(settings);
  if (!trained) return trained.error();
  role->addPanel(settings.devices);
  role->addProjectors(settings.devices);
  role->cpu_latency_us_ = settings.devices.cpu_latency_us;
  for (std::size_t i = 0; i < settings.devices.list.size(); ++i) {
    const DeviceSettings& device = settings.devices.list[i];
    role->segment_->health[i].publish(absent(!device.line.port.empty(), clock.now()));
    role->publishFrames(settings.devices, i);
    role->lines_.push_back(std::make_unique<Line>());
    role->lines_[i]->name = device.name;
    role->lines_[i]->chain =
        std::make_unique<DeviceChain>(settings.devices, i, *trained, generation, *role->segment_);
    if (device.line.port.empty()) continue;
    if (const auto opened = role->open(i, settings.devices); !opened) return opened.error();
  }
  return role;
}

Result<std::string> DevicesRole::mend() {
  auto mended = segment_.mend();
  auto flight = flight_.mend();
  if (!mended || !flight) return mended ? flight : mended;
  return *mended + (mended->empty() || flight->empty() ? "" : "; ") + *flight;
}

void DevicesRole::publishFrames(const DevicesSettings& settings, std::size_t device) {
  const DevicePlace place = devicePlaces(settings)[device];
  if (place.kind == SampleKind::kTracker)
    segment_->tracker[place.of_kind].frames.publish(framesOf(settings.list[device]));
}

// Makes the loop of a device; starts no thread. REQUIRES: the device has a port.
Result<Ok> DevicesRole::open(std::size_t device, const DevicesSettings& settings) {
  const LineSettings& line = settings.list[device].line;
  const DriverEntry* driver = findDriver(line.driver);
  if (!driver) return Error{Errc::kInvalidArgument, "there is no driver named " + line.driver};
  const auto address = parsePort(line.port);
  if (!address) return address.error();
  DeviceLoopSettings loop;
  loop.port = line.port;
  loop.baud = line.baud;
  loop.max_bytes_s = paceOf(line, *address);
  loop.on_pace = [](bool above) { above ? giveUpRealTime() : askForRealTime(); };
  Line& entry = *lines_[device];
  ByteTap& tap = flight_.ringOf(device, entry.name, line.driver, line.baud);
  entry.loop = std::make_unique<DeviceLoop>(
      loop, Opener(*address, line.baud, tap, entry.progress, clock_),
      driver->make(settings.list[device].own, clock_, entry.chain->samples()),
      entry.chain->health(), clock_);
  return Ok{};
}

void DevicesRole::start(Line& line) {
  if (!line.loop) return;
  line.thread =
      WatchedThread(watch_, line.name, [&line](const std::stop_token& stop, Progress& progress) {
        line.progress = &progress;
        askForRealTime();
        line.loop->run(stop, [&progress] { progress.step(); });
      });
}

// Stops the device's thread, if it has one, and ends the actions that its inputs hold.
void DevicesRole::close(std::size_t device) {
  Line& line = *lines_[device];
  line.thread.stop();
  line.loop.reset();
  flight_.expectEnd(device);
  line.chain->close(toNanoseconds(clock_.now()));
}

void DevicesRole::reload(const Settings& settings, const DevicesChanges& changes,
                         const Trained& trained) {
  const DevicesSettings& devices = settings.devices;
  for (const auto& line : lines_) {
    if (changes.bindings) line->chain->rebind(devices);
    if (changes.hand) line->chain->reloadHands(devices);
    if (changes.postures) line->chain->reloadPostures(trained, devices);
    if (changes.gestures || changes.hand) line->chain->reloadGestures(trained, devices);
  }
  if (changes.bindings && panel_actions_) panel_actions_->rebind(devices.bindings);
  for (std::size_t i = 0; i < lines_.size() && i < changes.lines.size(); ++i) {
    if (!changes.lines[i]) continue;
    close(i);
    publishFrames(devices, i);
    if (devices.list[i].line.port.empty()) {
      segment_->health[i].publish(absent(false, clock_.now()));
      continue;
    }
    [[maybe_unused]] const auto opened = open(i, devices);
    assert(opened);
    start(*lines_[i]);
  }
}

void DevicesRole::addPanel(const DevicesSettings& devices) {
  const GpioSettings& settings = devices.gpio;
  segment_->gpio_health.publish(absent(!settings.chip.empty(), clock_.now()));
  if (settings.chip.empty()) return;
  panel_health_ = std::make_unique<shm::ShmHealthSink>(segment_->gpio_health);
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
  panel_actions_ = std::make_unique<actions::ActionWriter>(
      devices.bindings, actions::Source{}, generation_, segment_->actions[shm::kPanelSource]);
  panel_ = std::make_unique<gpio::PanelLoop>(
      settings, open, publish, *panel_health_, clock_,
      [this] { panel_actions_->press(toNanoseconds(clock_.now())); });
}

void DevicesRole::addProjectors(const DevicesSettings& devices) {
  panel_switches_projectors_ = panel_ && devices.gpio.projector_line >= 0;
  if (!panel_switches_projectors_ && devices.projectors.empty()) return;
  Projectors::Parts parts{nullptr,
                          [](const TcpAddress& to) { return io::openTcp(to.host, to.port); },
                          &localMinute, clock_};
  if (panel_switches_projectors_)
    parts.panel = [this](const std::string& command) { return panel_->execute(command); };
  projectors_ = std::make_unique<Projectors>(devices, std::move(parts));
}

std::optional<pjlink::ProjectorState> DevicesRole::panelProjectors() const {
  if (!panel_switches_projectors_) return std::nullopt;
  constexpr pjlink::Power kPowers[] = {pjlink::Power::kOff, pjlink::Power::kWarming,
                                       pjlink::Power::kOn, pjlink::Power::kCooling};
  pjlink::ProjectorState state;
  state.name = "panel";
  const auto sample = segment_->gpio.newest();
  const auto health = segment_->gpio_health.read();
  if (!health) return state;
  const bool works = health->state == HealthState::kOk;
  state.health = works ? pjlink::Health::kOk : pjlink::Health::kUnreachable;
  state.reason = health->reason;
  state.address = health->port;
  if (works && sample && sample->power < std::size(kPowers)) state.power = kPowers[sample->power];
  const Duration left = panel_ ? panel_->phaseLeft() : Duration::zero();
  if (works && left > Duration::zero()) state.within = left;
  return state;
}

void DevicesRole::start() {
  if (cpu_latency_us_ >= 0) {
    if (auto limit = io::limitCpuLatency(cpu_latency_us_))
      cpu_latency_ = *std::move(limit);
    else
      logWarning("/cpu_latency_us: {}", limit.error().what);
  }
  if (panel_) {
    threads_.emplace_back(watch_, "panel", [this](const std::stop_token& stop, Progress& progress) {
      panel_->run(stop, [&progress] { progress.step(); });
    });
  }
  if (projectors_) projectors_->start(watch_, threads_);
  for (const auto& line : lines_) start(*line);
}

DevicesRole::~DevicesRole() {
  for (WatchedThread& thread : threads_) thread.requestStop();
  for (const auto& line : lines_) line->thread.requestStop();
  threads_.clear();
  for (const auto& line : lines_) line->thread.stop();
}

}  // namespace merlin::devices
