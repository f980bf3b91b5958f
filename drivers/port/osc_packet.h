// Open Sound Control 1.0: the messages of a datagram. The only place that sees oscpack, whose
// exceptions end here.
//
// Source: M. Wright, The Open Sound Control 1.0 Specification, 2002, opensoundcontrol.org.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace merlin {

struct OscArgument {
  enum Kind : std::uint8_t { kInteger, kReal, kText, kOther };  // kOther: any other type

  Kind kind = kOther;
  double number = 0;         // for kInteger and kReal; may be NaN or infinite
  std::int32_t integer = 0;  // for kInteger
  std::string_view text;     // for kText
};

struct OscMessage {
  std::string_view address;
  std::span<const OscArgument> arguments;
};

// Receives the messages of a datagram, in their order. All texts are valid only during the call.
class OscSink {
 public:
  virtual ~OscSink() = default;
  virtual void take(const OscMessage& message) noexcept = 0;
};

class OscReader {
 public:
  // Maximum nesting of bundles; no known sender comes near it.
  static constexpr int kDeepest = 8;
  static constexpr std::size_t kMostArguments = 512;

  OscReader();

  // Passes the messages of the datagram to `sink`. If any part of it is malformed, nested too
  // deeply or has too many arguments, passes none of them and returns false. Time tags of bundles
  // are ignored: all messages take effect on arrival. Allocates only if the datagram is malformed
  // (oscpack throws). Cost: linear in the datagram's length. A datagram that is longer than
  // kLongestDatagram is malformed.
  bool read(std::span<const std::byte> datagram, OscSink& sink) noexcept;

 private:
  std::vector<OscArgument> arguments_;
};

}  // namespace merlin
