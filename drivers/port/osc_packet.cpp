#include "drivers/port/osc_packet.h"

#include <exception>

#include <oscpack/osc/OscReceivedElements.h>

#include "drivers/port/datagram_line.h"

namespace merlin {
namespace {

// A bundle begins with this text and a time tag of eight bytes; then each element follows its
// size, a big-endian number of 32 bits.
constexpr std::string_view kBundle("#bundle\0", 8);
constexpr std::size_t kBundleHead = 16, kSizeField = 4;

std::uint32_t bigEndian32(std::string_view bytes) noexcept {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < kSizeField; ++i)
    word = word << 8 | static_cast<unsigned char>(bytes[i]);
  return word;
}

// Returns whether a message has a blob among its arguments. oscpack 1.1.0 does not check a blob's
// length (it constructs an exception but does not throw it), so later arguments would be read out
// of bounds. The address ends where oscpack sees its end: at the first group of four bytes whose
// last byte is zero.
bool hasBlob(std::string_view message) noexcept {
  std::size_t last = 3;
  while (message[0] != '\0' && last < message.size() && message[last] != '\0') last += 4;
  for (std::size_t tag = last + 1; tag < message.size() && message[tag] != '\0'; ++tag) {
    if (message[tag] == osc::BLOB_TYPE_TAG) return true;
  }
  return false;
}

OscArgument argumentOf(const osc::ReceivedMessageArgument& from) {
  OscArgument to;
  switch (from.TypeTag()) {
    case osc::INT32_TYPE_TAG:
      to.kind = OscArgument::kInteger;
      to.integer = static_cast<std::int32_t>(from.AsInt32Unchecked());
      to.number = to.integer;
      break;
    case osc::FLOAT_TYPE_TAG:
      to.kind = OscArgument::kReal;
      to.number = static_cast<double>(from.AsFloatUnchecked());
      break;
    case osc::DOUBLE_TYPE_TAG:
      to.kind = OscArgument::kReal;
      to.number = from.AsDoubleUnchecked();
      break;
    case osc::STRING_TYPE_TAG:
      to.kind = OscArgument::kText;
      to.text = from.AsStringUnchecked();
      break;
    default: break;
  }
  return to;
}

// Reads one packet; if `sink` is null, only checks it. Bundles are taken apart here, since oscpack
// 1.1.0 adds 4 to an element's size in 32 bits: for the size 0xFFFFFFFC it goes on at the same
// place for ever. oscpack reads single messages only, whose length is known to be within the
// datagram.
class Reading {
 public:
  Reading(std::vector<OscArgument>& arguments, OscSink* sink)
      : arguments_(arguments), sink_(sink) {}

  // Reads a message or a bundle; `depth`: number of bundles around it. Returns false if it is
  // malformed or a limit is exceeded; throws the exceptions of oscpack if a message is malformed.
  bool element(std::string_view bytes, int depth) {
    if (bytes.empty() || bytes.size() % 4 != 0) return false;
    return bytes[0] == kBundle[0] ? bundle(bytes, depth) : message(bytes);
  }

 private:
  bool bundle(std::string_view bytes, int depth) {
    if (depth >= OscReader::kDeepest || bytes.size() < kBundleHead || !bytes.starts_with(kBundle))
      return false;
    for (auto rest = bytes.substr(kBundleHead); !rest.empty();) {
      if (rest.size() < kSizeField) return false;
      const std::size_t size = bigEndian32(rest);
      rest.remove_prefix(kSizeField);
      if (size > rest.size() || !element(rest.substr(0, size), depth + 1)) return false;
      rest.remove_prefix(size);
    }
    return true;
  }

  bool message(std::string_view bytes) {
    if (hasBlob(bytes)) return true;
    const osc::ReceivedMessage message(osc::ReceivedPacket(bytes.data(), bytes.size()));
    if (message.ArgumentCount() > arguments_.size()) return false;
    std::size_t count = 0;
    for (auto at = message.ArgumentsBegin(); at != message.ArgumentsEnd(); ++at)
      arguments_[count++] = argumentOf(*at);
    if (sink_) sink_->take({message.AddressPattern(), std::span(arguments_).first(count)});
    return true;
  }

  std::vector<OscArgument>& arguments_;
  OscSink* sink_;
};

}  // namespace

OscReader::OscReader() : arguments_(kMostArguments) {}

bool OscReader::read(std::span<const std::byte> datagram, OscSink& sink) noexcept {
  if (datagram.size() > kLongestDatagram) return false;
  const std::string_view bytes(reinterpret_cast<const char*>(datagram.data()), datagram.size());
  try {
    return Reading(arguments_, nullptr).element(bytes, 0) &&
           Reading(arguments_, &sink).element(bytes, 0);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace merlin
