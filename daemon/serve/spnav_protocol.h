// The protocol of the space-mouse socket, with the server's state for one client: converts bytes to
// requests and samples to events. No I/O, no clock.
//
// To the client: messages of 32 bytes, i32[8] in the machine's byte order. Events: 0 motion x y z
// rx ry rz ms; 1 press, 2 release: the button; 3 device: 0 added or 1 removed, id, type; 5 raw
// axis: number, value; 6 raw button: number, 1 down. From the client: version 0: 4 bytes, a float
// (sensitivity). Version 1: first the word 0x7FAA5501, which is echoed, then only frames of 32
// bytes: a word whose lower half is the request's number, and seven words. The upper half is
// 0x7FAA, or 0 (as libspnav 1.0 sends a client's name). The answer has the same first word, and 0
// or -1 in the last one.
//
// Source: FreeSpacenav, spacenavd/src/proto_unix.c and libspnav/src/spnav.c; README.md beside this.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/port/samples.h"

namespace merlin::serve {

// Properties of the ball that a client may ask for.
struct SpnavDevice {
  std::string name = "MERLIN ball";
  std::string path;
  int buttons = 12;
  int type = 0;  // 0x100 Spaceball 1003 or 2003, 0x101 3003, 0x102 4000; 0: unknown
};

// Describes the ball of a health record by its identity ("Spaceball 2003, firmware 2.43") and port
// ("serial:/dev/ttyS0", "tcp://host:port"). `path` is set only if the port has one.
SpnavDevice spnavDevice(std::string_view identity, std::string_view port);

class SpnavClient {
 public:
  explicit SpnavClient(const SpnavDevice& device) : device_(device) {}

  struct Taken {
    std::size_t bytes = 0, messages = 0;
    bool answered = false;  // one of the messages was answered: the client now reads that answer
  };
  // Takes at most `most` complete messages off the front of `input` and appends the answers to
  // `out`.
  Taken receive(std::string_view input, std::size_t most, std::string& out);

  // Appends the events of a new sample that the client's mask requests: buttons that have changed
  // since the client's last sample, then a motion if any axis is not 0, or all have just become 0.
  // If `motion` is false, as for a client that is too slow, the motion is omitted; buttons are
  // never omitted.
  void sample(const BallSample& sample, bool motion, std::string& out);

  // Appends the event that the ball was connected or lost; `device` describes it from now on.
  void device(bool there, const SpnavDevice& device, std::string& out);

  int version() const noexcept { return version_; }

 private:
  using Words = std::array<std::int32_t, 8>;
  void request(Words words, std::string& out);
  bool configuration(std::uint32_t number, Words& words) const;
  void sendRaw(const BallSample& sample, std::string& out);
  void sendText(std::int32_t request, const std::string& text, std::string& out) const;

  SpnavDevice device_;
  int version_ = 0;
  float sensitivity_ = 1;
  std::uint32_t mask_ = 0x7;            // 1 motion, 2 button, 4 device
  std::array<std::int16_t, 6> axes_{};  // raw axes of the last sample
  std::uint32_t buttons_ = 0;
  bool moving_ = false;
};

}  // namespace merlin::serve
