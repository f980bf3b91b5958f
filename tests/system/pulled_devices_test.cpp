// Each device of a full wall is pulled after each command of its opening dialogue, or after each
// part of what it sends unasked, and is plugged in again, while the others go on: two gloves, a
// tracker, two balls, two gamepads and two trackers of VRPN servers at one merlind. The test serves
// their lines itself, so that it can pull a device at a chosen byte. The pulling of a working
// device is tested in many_devices_test.
#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/base/unique_fd.h"
#include "daemon/net/connection_server.h"
#include "drivers/emulate/emulator.h"
#include "drivers/io/pty_master.h"
#include "drivers/registry.h"
#include "tests/support/device_bench.h"
#include "tests/support/evdev_records.h"
#include "tests/support/fake_stream.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn_messages.h"
#include "tests/system/contiguous.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

// The test's end of a device's line.
class Plug {
 public:
  virtual ~Plug() = default;
  virtual json entry() const = 0;  // the device's entry in the configuration's list
  // Plugs the device in; it will be pulled in its state number `state`, or not at all if that is
  // kNever.
  virtual void plug(std::size_t state) = 0;
  virtual void unplug() = 0;
  virtual bool pulled() const = 0;  // whether the state was reached and the device pulled
  // Called once merlind has opened the line.
  virtual void opened() {}
  virtual std::size_t states() const = 0;  // number of its states
  std::string name() const { return entry()["name"]; }
};

// A stream that notes how many bytes each write ends at.
class CountedStream final : public ByteStream {
 public:
  explicit CountedStream(FakeStream& line) : line_(line) {}
  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    return line_.read(buffer, timeout);
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override {
    ends.push_back((ends.empty() ? 0 : ends.back()) + bytes.size());
    return line_.write(bytes, timeout);
  }
  void interrupt() noexcept override {}

  std::vector<std::size_t> ends;  // total number of bytes written after each write

 private:
  FakeStream& line_;
};

// Emulated devices have been switched on for this long, so that they answer at once.
constexpr Duration kSwitchedOn = std::chrono::seconds(5);

// Returns the total number of bytes after each command of the driver's dialogue with its emulator.
std::vector<std::size_t> commandsOf(const std::string& driver) {
  DeviceBench bench(driver.c_str(), {.baud = findDriver(driver)->baud}, "turning");
  const auto device = findDriver(driver)->make(DriverSettings{}, bench.clock, bench.sink);
  CountedStream line(bench.stream);
  bench.clock.advance(kSwitchedOn);
  EXPECT_TRUE(device->open(line)) << driver;
  return line.ends;
}

// A glove, a Fastrak or a ball. It is in state n when n + 1 commands have arrived.
class EmulatedPlug final : public Plug {
 public:
  EmulatedPlug(const TempDir& dir, std::string name, std::string driver)
      : link_(dir / ("line-" + name)),
        name_(std::move(name)),
        driver_(std::move(driver)),
        ends_(commandsOf(driver_)) {}
  json entry() const override { return deviceEntry(name_, driver_, "pty:" + link_); }
  void plug(std::size_t state) override {
    const std::size_t most = state == kNever ? kNever : ends_[state];
    pulled_ = false;
    auto line = std::make_unique<io::PtyMaster>(*io::PtyMaster::open(link_));
    thread_ =
        std::jthread([this, most, line = std::move(line)](const std::stop_token& stop) mutable {
          serve(stop, *line, most);
          line.reset();
          pulled_ = true;
        });
  }
  void unplug() override { thread_ = {}; }
  bool pulled() const override { return pulled_; }
  std::size_t states() const override { return ends_.size(); }

 private:
  void serve(const std::stop_token& stop, const io::PtyMaster& line, std::size_t most) {
    const SystemClock clock;
    const emulate::EmulatorEntry& made = *emulate::findEmulator(driver_);
    const auto device = made.make({.baud = made.baud}, *emulate::findMotionScript("turning"),
                                  clock.now() - kSwitchedOn);
    std::string out;
    for (std::size_t received = 0; received < most && !stop.stop_requested();) {
      device->advance(clock.now(), out);
      if (!out.empty()) (void)!::write(line.fd(), out.data(), out.size());
      out.clear();
      std::array<std::byte, 256> bytes{};
      pollfd item{line.fd(), POLLIN, 0};
      const Duration due =
          std::clamp<Duration>(device->nextDue() - clock.now(), Duration::zero(), milliseconds(20));
      const timespec limit{0, due.count()};
      if (::ppoll(&item, 1, &limit, nullptr) != 1) continue;
      const ssize_t n = ::read(line.fd(), bytes.data(), std::min(bytes.size(), most - received));
      if (n <= 0) continue;
      device->receive(std::span(bytes).first(static_cast<std::size_t>(n)), clock.now());
      received += static_cast<std::size_t>(n);
    }
  }

  std::string link_, name_, driver_;
  std::vector<std::size_t> ends_;
  std::atomic<bool> pulled_ = false;
  std::jthread thread_;
};

// A gamepad. It is in state n when entry n of kBeginnings has been sent.
class GamepadPlug final : public Plug {
 public:
  GamepadPlug(const TempDir& dir, std::string name)
      : link_(dir / ("line-" + name)), name_(std::move(name)) {}
  json entry() const override { return deviceEntry(name_, "evdev", "pty:" + link_); }
  void plug(std::size_t state) override {
    pulled_ = false;
    state_ = state;
    line_ = std::make_unique<io::PtyMaster>(*io::PtyMaster::open(link_));
    if (state == kNever)
      thread_ = std::jthread([this](const std::stop_token& stop) { speak(stop); });
  }
  void opened() override {
    if (state_ == kNever || !line_) return;
    say(0, kBeginnings[state_]);
    line_.reset();
    pulled_ = true;
  }
  void unplug() override {
    thread_ = {};
    line_.reset();
  }
  bool pulled() const override { return pulled_; }
  std::size_t states() const override { return kBeginnings.size(); }

 private:
  static constexpr std::size_t kRecord = 24;
  // Numbers of bytes: nothing, a part of a record, a record, most of the description, the whole
  // description, a part of a report.
  static constexpr std::array<std::size_t, 6> kBeginnings = {
      0, 10, kRecord, kRecord + 20, 2 * kRecord, 3 * kRecord};

  void say(int turn, std::size_t most) const {
    const std::string bytes =
        evdevRecord(EvdevRecord::kAxis, ABS_X, 0, -100, 100) + evdevRecord(EvdevRecord::kReady) +
        evdevRecord(EvdevRecord::kMoved, ABS_X, turn % 100) + evdevRecord(EvdevRecord::kReport);
    (void)!::write(line_->fd(), bytes.data(), std::min(bytes.size(), most));
  }
  // merlind drops what was sent before it opened the line, so the description is sent repeatedly.
  void speak(const std::stop_token& stop) const {
    for (int turn = 0; !stop.stop_requested(); ++turn) {
      say(turn, kNever);
      (void)::poll(nullptr, 0, 20);
    }
  }

  std::string link_, name_;
  std::size_t state_ = kNever;
  std::unique_ptr<io::PtyMaster> line_;
  bool pulled_ = false;
  std::jthread thread_;
};

// The tracker of a VRPN server. It is in state n when a client has been sent beginning number n of
// the server's messages; then the server ends.
class ServerPlug final : public Plug {
 public:
  explicit ServerPlug(std::string name) : name_(std::move(name)), port_(freePort()) {
    hello_.push_back("");
    hello_.push_back(vrpnCookie().substr(0, 10));
    hello_.push_back(vrpnCookie());
    hello_.push_back(hello_.back() + vrpnSender(0, "Tracker0"));
    hello_.push_back(hello_.back() + vrpnType(5, kVrpnPoseType).substr(0, 30));
    hello_.push_back(hello_[3] + vrpnType(5, kVrpnPoseType));
    hello_.push_back(hello_.back() + pose().substr(0, 40));
  }
  json entry() const override {
    return deviceEntry(name_, "vrpn", fmt::format("tcp://127.0.0.1:{}", port_));
  }
  void plug(std::size_t state) override {
    pulled_ = false;
    auto listener = std::make_unique<UniqueFd>(*net::listenTcp("127.0.0.1", port_));
    thread_ = std::jthread(
        [this, state, listener = std::move(listener)](const std::stop_token& stop) mutable {
          serve(stop, *listener, state);
          listener.reset();
          pulled_ = true;
        });
  }
  void unplug() override { thread_ = {}; }
  bool pulled() const override { return pulled_; }
  std::size_t states() const override { return hello_.size(); }

 private:
  static std::string pose() {
    constexpr float kPlace[] = {0.1F, 0.2F, 0.3F}, kTurn[] = {1, 0, 0, 0};
    return vrpnMessage(0, 5, vrpnPose(0, kPlace, kTurn));
  }
  void serve(const std::stop_token& stop, const UniqueFd& listener, std::size_t state) const {
    UniqueFd client;
    while (!stop.stop_requested()) {
      pollfd item{listener.get(), POLLIN, 0};
      std::string bytes = pose();
      if (::poll(&item, 1, 20) == 1) {
        client.reset(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
        bytes = state == kNever ? hello_[5] : hello_[state];
      }
      if (!client.valid()) continue;
      (void)::send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      std::array<char, 4096> pings{};  // pings are not answered, since poses arrive all the time
      (void)!::recv(client.get(), pings.data(), pings.size(), MSG_DONTWAIT);
      if (state != kNever) return;
    }
  }

  std::string name_;
  int port_;
  std::vector<std::string> hello_;
  std::atomic<bool> pulled_ = false;
  std::jthread thread_;
};

class PulledDevices : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"left", "right"}) emulated(name, "cyberglove");
    emulated("stage", "fastrak");
    for (const char* name : {"near", "far"}) emulated(name, "spaceball");
    for (const char* name : {"pad", "stick"})
      plugs_.push_back(std::make_unique<GamepadPlug>(dir_, name));
    for (const char* name : {"eyes", "head"}) plugs_.push_back(std::make_unique<ServerPlug>(name));
    json list = json::array();
    for (const auto& plug : plugs_) list.push_back(plug->entry());
    m_.emplace(dir_, "", "pulled",
               MerlindOptions{.role = "devices",
                              .emulate = false,
                              .also = {{"devices", list}, {"hands", json::array()}}});
    ASSERT_TRUE(m_->ready()) << m_->process().output();
    for (const auto& plug : plugs_) {
      plug->plug(kNever);
      ASSERT_TRUE(eventually([&] { return count(plug->name()) > 0; }))
          << plug->name() << m_->process().output();
      ASSERT_TRUE(m_->healthIs(plug->name(), HealthState::kOk)) << plug->name();
    }
  }
  void TearDown() override {
    for (const auto& plug : plugs_) plug->unplug();
  }
  void emulated(const char* name, const char* driver) {
    plugs_.push_back(std::make_unique<EmulatedPlug>(dir_, name, driver));
  }
  // Returns how many samples the device has sent.
  std::uint64_t count(const std::string& device) {
    const auto* const slots = m_->devices();
    if (const auto* const glove = slots->glove(device)) return glove->samples->count();
    if (const auto* const ball = slots->ball(device)) return ball->samples->count();
    return slots->tracker(device)->stations[0]->count();
  }
  HealthState stateOf(const Plug& plug) { return m_->health(plug.name())->state; }
  // Pulls the device in this state, and expects that the other devices lose nothing meanwhile.
  void pull(Plug& victim, std::size_t state) {
    const std::string where = fmt::format("{} in its state {}", victim.name(), state);
    victim.unplug();
    EXPECT_TRUE(m_->healthIs(victim.name(), HealthState::kAbsent)) << where;
    std::map<std::string, std::uint64_t> from;
    std::map<std::string, std::uint64_t> reconnects;
    for (const auto& plug : plugs_) {
      from[plug->name()] = count(plug->name());
      reconnects[plug->name()] = m_->health(plug->name())->reconnects;
    }
    victim.plug(state);
    EXPECT_TRUE(eventually([&] {
      if (stateOf(victim) == HealthState::kOpening) victim.opened();
      // On a busy machine the dialogue may be shorter than was measured, so that this state is
      // never reached; the device is then pulled at the dialogue's end.
      if (stateOf(victim) == HealthState::kOk) victim.unplug();
      return victim.pulled();
    })) << where;
    EXPECT_TRUE(m_->healthIs(victim.name(), HealthState::kAbsent)) << where;
    EXPECT_STRNE(m_->health(victim.name())->reason, "") << where;
    for (const auto& other : plugs_) {
      if (other.get() == &victim) continue;
      EXPECT_TRUE(eventually([&] { return count(other->name()) > from[other->name()] + 5; }))
          << other->name() << " while " << where << " is pulled";
      EXPECT_TRUE(m_->healthIs(other->name(), HealthState::kOk)) << other->name() << ", " << where;
      expectContiguous(*m_->devices(), other->name(), from[other->name()]);
      EXPECT_EQ(m_->health(other->name())->reconnects, reconnects[other->name()])
          << other->name() << ", " << where;
    }
  }

  TempDir dir_;
  std::vector<std::unique_ptr<Plug>> plugs_;
  std::optional<Merlind> m_;
};

TEST_F(PulledDevices, EachIsPulledInEachStateOfItsDialogueAndTheOthersLoseNothing) {
  // One device of each kind is pulled; a second device of the same kind remains.
  for (const char* name : {"left", "stage", "near", "pad", "eyes"}) {
    const auto found =
        std::ranges::find_if(plugs_, [&](const auto& plug) { return plug->name() == name; });
    Plug& victim = **found;
    ASSERT_GE(victim.states(), 3u) << name;
    for (std::size_t state = 0; state < victim.states(); ++state) pull(victim, state);
    victim.unplug();
    const std::uint64_t before = count(name);
    victim.plug(kNever);
    EXPECT_TRUE(m_->healthIs(name, HealthState::kOk)) << name << m_->process().output();
    EXPECT_TRUE(eventually([&] { return count(name) > before + 5; })) << name;
  }
  EXPECT_EQ(m_->process().kill(SIGTERM), 0) << m_->process().output();
}

}  // namespace
}  // namespace merlin::test
