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
  enum Kind : std::uint8_t { kInteger, kReal, kText, kOther };  // kOther: of another type

  Kind kind = kOther;
  double number = 0;         // of kInteger and kReal; may be NaN or infinite
  std::int32_t integer = 0;  // of kInteger
  std::string_view text;     // of kText
};

struct OscMessage {
  std::string_view address;
  std::span<const OscArgument> arguments;
};

// Receives the messages of a datagram, in their order. All texts last as long as the call.
class OscSink {
 public:
  virtual ~OscSink() = default;
  virtual void take(const OscMessage& message) noexcept = 0;
};

class OscReader {
 public:
  // Bundles may be nested; more than this is no packet that anybody sends.
  static constexpr int kDeepest = 8;
  static constexpr std::size_t kMostArguments = 512;

  OscReader();

  // Passes on the messages of the datagram; if any part of it is malformed, nested too deeply or
  // has too many arguments, none of them, and returns false. Time tags of bundles are not looked
  // at: what arrives counts now. Allocates only if the datagram is malformed (oscpack throws).
  // Cost: linear in the datagram's length, for each level of nesting. A datagram that is longer
  // than kLongestDatagram is malformed.
  bool read(std::span<const std::byte> datagram, OscSink& sink) noexcept;

 private:
  std::vector<char> packet_;  // a copy of the datagram, followed by zeros
  std::vector<OscArgument> arguments_;
};

}  // namespace merlin
