// NamedPacket: a packet with a name, as a parameter of the damage tests; ctest then lists the test
// by the name, not by the packet's bytes.
#pragma once

#include <ostream>
#include <string>

namespace merlin::test {

struct NamedPacket {
  const char* name;
  std::string bytes;

  friend std::ostream& operator<<(std::ostream& out, const NamedPacket& packet) {
    return out << packet.name;
  }
};

}  // namespace merlin::test
