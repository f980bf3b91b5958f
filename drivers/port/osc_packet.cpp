#include "drivers/port/osc_packet.h"

#include <algorithm>
#include <exception>

#include <oscpack/osc/OscReceivedElements.h>

#include "drivers/port/datagram_line.h"

namespace merlin {
namespace {

// oscpack compares the first eight bytes of an element with "#bundle" even if the element is
// shorter, so that many zeros follow the copy.
constexpr std::size_t kPadding = 8;

// Whether a message has a blob among its arguments. oscpack 1.1.0 does not check a blob's length
// (it constructs an exception but does not throw it), so later arguments would be read out of
// bounds. The address ends where oscpack sees its end: at the first group of four bytes whose last
// byte is zero.
bool hasBlob(const char* message, std::size_t size) noexcept {
  std::size_t last = 3;
  while (message[0] != '\0' && last < size && message[last] != '\0') last += 4;
  for (std::size_t tag = last + 1; tag < size && message[tag] != '\0'; ++tag) {
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

// Reads one packet; if `sink` is null, only checks it. Throws the exceptions of oscpack, and
// osc::Exception if a limit is exceeded.
class Reading {
 public:
  Reading(std::vector<OscArgument>& arguments, OscSink* sink)
      : arguments_(arguments), sink_(sink) {}

  void bundle(const osc::ReceivedBundle& bundle, int depth) {
    if (depth >= OscReader::kDeepest) throw osc::Exception("nested too deeply");
    for (auto element = bundle.ElementsBegin(); element != bundle.ElementsEnd(); ++element) {
      if (element->IsBundle())
        this->bundle(osc::ReceivedBundle(*element), depth + 1);
      else
        message(*element);
    }
  }

  // `Holder`: a packet, or an element of a bundle.
  template <typename Holder>
  void message(const Holder& holder) {
    if (hasBlob(holder.Contents(), static_cast<std::size_t>(holder.Size()))) return;
    const osc::ReceivedMessage message(holder);
    if (message.ArgumentCount() > arguments_.size()) throw osc::Exception("too many arguments");
    std::size_t count = 0;
    for (auto at = message.ArgumentsBegin(); at != message.ArgumentsEnd(); ++at)
      arguments_[count++] = argumentOf(*at);
    if (sink_) sink_->take({message.AddressPattern(), std::span(arguments_).first(count)});
  }

 private:
  std::vector<OscArgument>& arguments_;
  OscSink* sink_;
};

}  // namespace

OscReader::OscReader() : packet_(kLongestDatagram + kPadding), arguments_(kMostArguments) {}

bool OscReader::read(std::span<const std::byte> datagram, OscSink& sink) noexcept {
  if (datagram.size() > kLongestDatagram) return false;
  std::transform(datagram.begin(), datagram.end(), packet_.begin(),
                 [](std::byte b) { return static_cast<char>(b); });
  std::fill_n(packet_.begin() + static_cast<std::ptrdiff_t>(datagram.size()), kPadding, '\0');
  try {
    const osc::ReceivedPacket packet(packet_.data(), datagram.size());
    for (OscSink* const to : {static_cast<OscSink*>(nullptr), &sink}) {
      Reading reading(arguments_, to);
      if (packet.IsBundle())
        reading.bundle(osc::ReceivedBundle(packet), 0);
      else
        reading.message(packet);
    }
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

}  // namespace merlin
