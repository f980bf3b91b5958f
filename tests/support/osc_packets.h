// Open Sound Control 1.0 packets as a sender makes them: messages, bundles, and frames of TUIO 1.1.
// They are written by hand after the specifications, since MERLIN itself sends none.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "drivers/port/datagram_line.h"

namespace merlin::test {

// An argument of a message; its type tag is i, f, d or s.
using OscValue = std::variant<int, float, double, std::string>;

inline std::string oscWord(std::uint32_t word) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(word >> shift & 0xFF);
  return bytes;
}

// Returns a string as OSC packs it: 1 to 4 zero bytes are appended, so that the length is a
// multiple of four.
inline std::string oscText(std::string text) {
  text.append(4 - text.size() % 4, '\0');
  return text;
}

inline std::string oscMessage(const std::string& address, const std::vector<OscValue>& values) {
  std::string tags = ",", bytes;
  for (const OscValue& value : values) {
    tags += "ifds"[value.index()];
    if (const auto* i = std::get_if<int>(&value)) bytes += oscWord(static_cast<std::uint32_t>(*i));
    if (const auto* f = std::get_if<float>(&value))
      bytes += oscWord(std::bit_cast<std::uint32_t>(*f));
    if (const auto* d = std::get_if<double>(&value)) {
      const auto bits = std::bit_cast<std::uint64_t>(*d);
      bytes += oscWord(static_cast<std::uint32_t>(bits >> 32)) +
               oscWord(static_cast<std::uint32_t>(bits & 0xFFFFFFFF));
    }
    if (const auto* s = std::get_if<std::string>(&value)) bytes += oscText(*s);
  }
  return oscText(address) + oscText(tags) + bytes;
}

// Returns a bundle with the time tag "immediately".
inline std::string oscBundle(const std::vector<std::string>& elements) {
  std::string bytes = oscText("#bundle") + oscWord(0) + oscWord(1);
  for (const std::string& element : elements)
    bytes += oscWord(static_cast<std::uint32_t>(element.size())) + element;
  return bytes;
}

// Returns the datagram as a record in the format of a port of kind udp:.
inline std::string datagram(std::string_view bytes, std::uint32_t sender = 1) {
  std::string out;
  append({sender, std::as_bytes(std::span(bytes))}, out);
  return out;
}

struct TuioContact {
  int session;
  float x, y;
};

// Returns a TUIO frame of fingers. The contacts in `set` are new or have moved; those in `set` and
// those in `alive` are listed as present.
inline std::string tuioCursors(int frame, const std::vector<TuioContact>& set,
                               std::vector<int> alive = {}, const std::string& source = {}) {
  constexpr const char* kAddress = "/tuio/2Dcur";
  std::vector<std::string> elements;
  if (!source.empty()) elements.push_back(oscMessage(kAddress, {std::string("source"), source}));
  for (const TuioContact& c : set) alive.push_back(c.session);
  std::vector<OscValue> sessions = {std::string("alive")};
  sessions.insert(sessions.end(), alive.begin(), alive.end());
  elements.push_back(oscMessage(kAddress, sessions));
  for (const TuioContact& c : set)
    elements.push_back(
        oscMessage(kAddress, {std::string("set"), c.session, c.x, c.y, 0.0F, 0.0F, 0.0F}));
  elements.push_back(oscMessage(kAddress, {std::string("fseq"), frame}));
  return oscBundle(elements);
}

// Returns a TUIO frame with one marked object, of class 7 and rotated by 1.5 rad.
inline std::string tuioObject(int frame, const TuioContact& c) {
  constexpr const char* kAddress = "/tuio/2Dobj";
  return oscBundle({oscMessage(kAddress, {std::string("alive"), c.session}),
                    oscMessage(kAddress, {std::string("set"), c.session, 7, c.x, c.y, 1.5F, 0.0F,
                                          0.0F, 0.0F, 0.0F, 0.0F}),
                    oscMessage(kAddress, {std::string("fseq"), frame})});
}

}  // namespace merlin::test
