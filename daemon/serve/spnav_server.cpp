#include "daemon/serve/spnav_server.h"

#include <optional>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/fixed_text.h"
#include "daemon/base/log.h"

namespace merlin::serve {
namespace {

constexpr Duration kSpnavRound = std::chrono::milliseconds(20);
constexpr Duration kCheckPeriod = std::chrono::seconds(1);
constexpr Duration kQuiet = std::chrono::milliseconds(60);
constexpr Duration kLongestQuiet =
    std::chrono::milliseconds(500);  // for a client that keeps asking
constexpr unsigned kMode = 0666;     // any user's programs may read the ball, as with spacenavd
constexpr std::size_t kMostPending = 4096;

net::ServerLimits spnavLimits() {
  net::ServerLimits l;
  l.input_bytes = 1024;
  l.output_bytes = kMostPending;
  return l;
}

std::uint64_t inodeOf(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

std::vector<const std::atomic<std::uint32_t>*> wakeWords(const shm::DeviceSlots& devices) {
  std::vector<const std::atomic<std::uint32_t>*> words;
  for (const auto& ball : devices.balls) words.push_back(&ball.samples->wakeWord());
  return words;
}

class SpnavSession final : public net::Session {
 public:
  SpnavSession(const SpnavDevice& device, const Clock& clock)
      : clock_(clock), client_(device), quiet_until_(clock.now() + kQuiet) {}

  Result<Taken> receive(std::string_view input, std::size_t most, std::string& output) override {
    const auto taken = client_.receive(input, most, output);
    if (taken.answered) quiet_until_ = clock_.now() + kQuiet;
    return Taken{taken.bytes, taken.messages};
  }
  // The protocol has no handshake: a client of version 0 may only listen.
  bool established() const noexcept override { return true; }

  void sample(const BallSample& sample, std::string& output) {
    const bool quiet = waits();
    if (!quiet) output += std::exchange(held_, {});
    std::string& told = quiet ? held_ : output;
    // A client that is too slow, or waits for an answer, misses motions, but no buttons.
    missed_ = quiet || !output.empty();
    client_.sample(sample, !missed_, told);
  }
  // Appends what the client missed while it waited for an answer or did not read.
  void sendMissed(const std::optional<BallSample>& newest, std::string& output) {
    if (waits()) return;
    waiting_since_.reset();
    output += std::exchange(held_, {});
    if (missed_device_) client_.device(there_, device_, output);
    missed_device_ = false;
    if (missed_ && newest && output.empty()) sample(*newest, output);
  }
  void device(bool there, const SpnavDevice& device) {
    there_ = there;
    device_ = device;
    missed_device_ = true;
  }

 private:
  const Clock& clock_;
  SpnavClient client_;
  // Whether events have to wait; limited in time and in the number of events held back.
  bool waits() {
    const Timestamp now = clock_.now();
    if (now >= quiet_until_ || held_.size() >= kMostPending / 2) return false;
    if (!waiting_since_) waiting_since_ = now;
    return now - *waiting_since_ < kLongestQuiet;
  }

  Timestamp quiet_until_;
  std::optional<Timestamp> waiting_since_;
  std::string held_;     // button events held back
  bool missed_ = false;  // the client missed the motion of the newest sample
  // missed_device_: the ball was connected or lost, and the client has not been told yet.
  bool missed_device_ = false, there_ = false;
  SpnavDevice device_;
};

}  // namespace

Result<std::unique_ptr<SpnavServer>> SpnavServer::start(const std::string& path,
                                                        const shm::DeviceSlots& devices,
                                                        ThreadWatch& watch, const Clock& clock) {
  auto listener = net::listenLocal(path, kMode);
  if (!listener) return listener.error();
  return std::unique_ptr<SpnavServer>(
      new SpnavServer(path, *std::move(listener), devices, watch, clock));
}

SpnavServer::SpnavServer(std::string path, UniqueFd listener, const shm::DeviceSlots& devices,
                         ThreadWatch& watch, const Clock& clock)
    : path_(std::move(path)),
      devices_(devices),
      clock_(clock),
      server_("space mouse", spnavLimits(), clock),
      waker_(wakeWords(devices), watch, "samples for the space mouse") {
  for (const auto& ball : devices.balls) balls_.push_back({ball, ball.samples->count()});
  updateHealth();
  listen(std::move(listener));
  thread_ = net::ServerThread(watch, "space mouse", [this] { round(); });
}

void SpnavServer::listen(UniqueFd listener) {
  file_ = inodeOf(path_);
  server_.listen(std::move(listener), [this](const net::Peer&) {
    return std::make_unique<SpnavSession>(device_, clock_);
  });
}

// Creates the socket again if its file was removed, as status/relay does; connections stay.
void SpnavServer::listenAgainWhereGone() {
  const Timestamp now = clock_.now();
  if (now - checked_ < kCheckPeriod) return;
  checked_ = now;
  if (inodeOf(path_) == file_) return;
  auto listener = net::listenLocal(path_, kMode);
  if (!listener) return;  // another file is there, or the folder is missing: tried again later
  server_.stopListening();
  listen(*std::move(listener));
  logWarning("space mouse: its socket {} was removed and has been created again", path_);
}

SpnavServer::~SpnavServer() {
  thread_.stop();
  if (inodeOf(path_) == file_) ::unlink(path_.c_str());
}

void SpnavServer::round() {
  const int wakers[] = {waker_.fd()};
  server_.round(kSpnavRound, wakers);
  waker_.clear();
  listenAgainWhereGone();
  updateHealth();
  sendSamples();
  sendMissed();
}

void SpnavServer::updateHealth() {
  bool there = false;
  for (const Ball& ball : balls_) {
    const auto health = ball.slots.health->read();
    if (!health) return;  // not known yet, or being written: unchanged
    if (there || health->state != HealthState::kOk) continue;
    there = true;
    if (!there_) device_ = spnavDevice(textIn(health->identity), textIn(health->port));
  }
  if (there == there_) return;
  there_ = there;
  server_.sendToAll([&](net::Session& session, std::string&) {
    static_cast<SpnavSession&>(session).device(there, device_);
  });
}

void SpnavServer::sendSamples() {
  for (Ball& ball : balls_) {
    const shm::Channel<BallSample>& samples = *ball.slots.samples;
    const std::uint64_t count = samples.count();
    if (count - ball.seen > shm::kHistory / 2) ball.seen = count - 1;
    for (; ball.seen < count; ++ball.seen) {
      const auto sample = samples.at(ball.seen);
      if (!sample) continue;
      last_ = &samples;
      server_.sendToAll([&](net::Session& session, std::string& output) {
        static_cast<SpnavSession&>(session).sample(*sample, output);
      });
    }
  }
}

void SpnavServer::sendMissed() {
  const auto newest = last_ ? last_->newest() : std::nullopt;
  server_.sendToAll([&](net::Session& session, std::string& output) {
    static_cast<SpnavSession&>(session).sendMissed(newest, output);
  });
}

}  // namespace merlin::serve
