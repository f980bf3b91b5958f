// NamedPacket: a parameter of the damage tests; ctest lists it by its name instead of its bytes.
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
