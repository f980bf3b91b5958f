// The space-mouse socket's protocol, one client's side of a server: bytes to requests, samples to
// events. No I/O, no clock.
//
// To the client, 32 bytes each: i32[8] in the machine's order. An event: 0 motion x y z rx ry rz
// ms; 1 press, 2 release: the button; 3 device: 0 added or 1 removed, id, type. From the client:
// version 0, a float (sensitivity); version 1, the word 0x7FAA5501 first, which is echoed, then
// requests of 32 bytes, 0x7FAA0000 + number and seven words, answered by the same word, the last
// one 0 or -1.
//
// Source: FreeSpacenav, spacenavd/src/proto_unix.c and libspnav/src/spnav.c; README.md beside this.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/port/samples.h"

namespace merlin::serve {

// What a client may ask about the ball.
struct SpnavDevice {
  std::string name = "MERLIN ball";
  std::string path;
  int buttons = 12;
  int type = 0x101;  // 0x100 Spaceball 1003 or 2003, 0x101 3003, 0x102 4000
};

class SpnavClient {
 public:
  explicit SpnavClient(const SpnavDevice& device) : device_(device) {}

  // Takes what came from the client; what is to be sent back is appended to `out`.
  void receive(std::span<const std::byte> bytes, std::string& out);

  // Appends the events of a new sample, as the client wants them: buttons that have changed since
  // the client's last sample, then a motion if any axis is not 0, or has just become so. `motion`
  // false leaves that out: for a client that is too slow, buttons are never lost.
  void sample(const BallSample& sample, bool motion, std::string& out);

  // The ball came or went.
  void device(bool there, std::string& out);

  int version() const noexcept { return version_; }

 private:
  using Words = std::array<std::int32_t, 8>;
  void request(Words words, std::string& out);
  void sendText(std::int32_t request, const std::string& text, std::string& out) const;

  SpnavDevice device_;
  int version_ = 0;
  float sensitivity_ = 1;
  std::uint32_t mask_ = 0x7;  // 1 motion, 2 button, 4 device
  std::string input_;
  std::uint32_t buttons_ = 0;
  bool moving_ = false;
};

}  // namespace merlin::serve
