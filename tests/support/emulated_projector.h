// EmulatedProjector: a PJLink projector with warm-up and cool-down, as a function from bytes to
// bytes. ProjectorServer: such a projector at a TCP port, which misbehaves as the test chooses.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "daemon/base/clock.h"
#include "daemon/base/unique_fd.h"
#include "drivers/pjlink/digest.h"

namespace merlin::test {

// Thread-bound.
class EmulatedProjector {
 public:
  explicit EmulatedProjector(std::string password = {}) : password_(std::move(password)) {}

  Duration warm_up = std::chrono::seconds(30), cool_down = std::chrono::seconds(90);
  // answer to every command that switches the power, for example "ERR3"; empty: the projector obeys
  std::string refusal;
  std::string log;  // each command that switched the power: '1' (on) or '0' (off)
  std::string errors = "000000", lamps = "1234 1", name = "Epsilon";
  std::string inputs;  // each input that was selected, in order, with a blank after each

  // Ends the warm-up or cool-down at once.
  void endPhase() { phase_until_ = {}; }

  // The greeting, which is the first thing sent on a connection.
  std::string greet() {
    authenticated_ = password_.empty();
    return authenticated_ ? "PJLINK 0\r" : "PJLINK 1 498e4a67\r";
  }

  // Returns the answer to one line; `line` is without its line end.
  std::string answer(std::string line, Timestamp now) {
    if (!authenticated_) {
      const std::string digest = pjlink::md5Hex("498e4a67" + password_);
      if (!line.starts_with(digest)) return "PJLINK ERRA\r";
      authenticated_ = true;
      line.erase(0, digest.size());
    }
    if (line == "%1POWR ?") return "%1POWR=" + std::string(1, power(now)) + "\r";
    if (line == "%1POWR 1" || line == "%1POWR 0") return "%1POWR=" + turn(line.back(), now) + "\r";
    if (line == "%1ERST ?") return "%1ERST=" + errors + "\r";
    if (line == "%1LAMP ?") return "%1LAMP=" + lamps + "\r";
    if (line == "%1NAME ?") return "%1NAME=" + name + "\r";
    if (line.starts_with("%1INPT ")) {
      inputs += line.substr(7) + " ";
      return "%1INPT=OK\r";
    }
    return line.substr(0, 6) + "=ERR1\r";
  }

  // Returns the power state: '0' off, '1' on, '2' cooling, '3' warming.
  char power(Timestamp now) {
    if (now >= phase_until_ && power_ == '3') power_ = '1';
    if (now >= phase_until_ && power_ == '2') power_ = '0';
    return power_;
  }

 private:
  std::string turn(char to, Timestamp now) {
    log += to;
    if (!refusal.empty()) return refusal;
    const char is = power(now);
    if (is == '2' || is == '3') return "ERR3";
    if (is == to) return "OK";
    power_ = to == '1' ? '3' : '2';
    phase_until_ = now + (to == '1' ? warm_up : cool_down);
    return "OK";
  }

  std::string password_;
  bool authenticated_ = false;
  char power_ = '0';
  Timestamp phase_until_{};
};

// Listens at 127.0.0.1 on a port that the system assigns; serves one connection after another.
class ProjectorServer {
 public:
  enum Manner {
    kPolite,
    kSilent,     // sends nothing, not even the greeting
    kHalf,       // closes in the middle of its first answer
    kJunk,       // sends bytes without end
    kOneAnswer,  // closes after each answer
    kDripping,   // sends one byte at a time of a greeting that never ends
  };

  explicit ProjectorServer(std::string password = {}) : projector(std::move(password)) { appear(); }

  // Ends the connection and the thread, and refuses further connections, as a projector without
  // mains does.
  void vanish() {
    thread_ = {};
    listener_.reset();
  }
  // Listens again, at the same port as before vanish().
  void appear() {
    listener_.reset(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const int yes = 1;
    ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port.empty() ? 0 : std::stoi(port)));
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_.get(), generic, size) != 0 || ::listen(listener_.get(), 8) != 0) return;
    ::getsockname(listener_.get(), generic, &size);
    port = std::to_string(ntohs(address.sin_port));
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }

  // Calls `change` with the projector, under the mutex; may be called at any time.
  template <typename Change>
  void set(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(projector);
  }

  std::string port;
  std::atomic<Manner> manner{kPolite};
  std::atomic<int> connections{0};
  // Used by the server's thread and set() under mutex_; other code may use it only after vanish().
  EmulatedProjector projector;

 private:
  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!isReady(listener_)) continue;
      const UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      ++connections;
      if (client.valid()) converse(stop, client);
    }
  }

  void converse(const std::stop_token& stop, const UniqueFd& client) {
    if (manner != kSilent && manner != kJunk && manner != kDripping) say(client, greeting());
    for (std::string line; !stop.stop_requested();) {
      if (manner == kJunk && !say(client, std::string(4096, 'x'))) return;
      if (manner == kDripping && !say(client, std::string(1, 'P'))) return;
      char byte = 0;
      if (!isReady(client)) continue;
      if (::recv(client.get(), &byte, 1, 0) != 1) return;
      if (byte != '\r') {
        line += byte;
        continue;
      }
      const std::string answer = answerTo(line);
      line.clear();
      if (manner == kHalf) return (void)say(client, answer.substr(0, 4));
      say(client, answer);
      if (manner == kOneAnswer) return;
    }
  }

  std::string greeting() {
    const std::lock_guard lock(mutex_);
    return projector.greet();
  }
  std::string answerTo(const std::string& line) {
    const std::lock_guard lock(mutex_);
    return projector.answer(line, clock_.now());
  }

  static bool isReady(const UniqueFd& fd) {
    pollfd item{fd.get(), POLLIN, 0};
    return ::poll(&item, 1, 20) == 1;
  }
  static bool say(const UniqueFd& fd, const std::string& text) {
    return ::send(fd.get(), text.data(), text.size(), MSG_NOSIGNAL) > 0;
  }

  SystemClock clock_;
  std::mutex mutex_;
  UniqueFd listener_;
  std::jthread thread_;
};

}  // namespace merlin::test
