// Catalog: the devices that a VRPN server describes to whoever connects, and what they measure as
// far as their messages tell. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "drivers/vrpn/protocol.h"

namespace merlin::vrpn {

// What MERLIN reads of VRPN.
struct Measures {
  bool poses = false, buttons = false, channels = false;

  bool any() const noexcept { return poses || buttons || channels; }
};

// Nothing of VRPN's says what a device is: it sends messages of several types. What rests may send
// none, and only a device's first message of a type shows that it has it.
struct CatalogDevice {
  std::string name;  // 1 to 99 bytes of text (isText()), no '@': a configuration can have it
  Measures sent;
};

// Keeps at most kMostDevices devices, whatever the server sends.
class Catalog {
 public:
  static constexpr std::size_t kMostDevices = 64;

  // Takes the next bytes from the server, its greeting first. Errors: kMalformed (no server of VRPN
  // 7, or a message with an invalid length), kClosed (it ends the connection); nothing can be taken
  // afterwards, and what was understood before stays.
  Result<Ok> take(std::string_view bytes);

  bool greeted() const noexcept { return greeting_.size() == kVrpnCookieLength; }
  // "07.38"; empty before the greeting. The server's bytes, which can be any.
  std::string_view version() const;
  // In the order in which they were described; without those of VRPN's own.
  const std::vector<CatalogDevice>& devices() const noexcept { return devices_; }
  // Descriptions of other devices: of names that no configuration can have, or too many.
  std::size_t leftOut() const noexcept { return left_out_; }
  // The types that the server has described: what any of its devices may measure.
  const Measures& described() const noexcept { return described_; }
  // If it is a server of MERLIN, of which instance; otherwise empty.
  const std::string& instance() const noexcept { return instance_; }

 private:
  void handle(const Message& message);
  void describeSender(std::int32_t number, std::string_view name);
  void describeType(std::int32_t number, std::string_view name);
  CatalogDevice* named(std::string_view name);

  std::string greeting_;
  Parser parser_;
  std::vector<CatalogDevice> devices_;
  std::map<std::int32_t, std::size_t> senders_;     // the server's number: index in devices_
  std::map<std::int32_t, bool Measures::*> types_;  // the server's number: what it is of
  Measures described_;
  std::string instance_;
  std::size_t left_out_ = 0;
};

}  // namespace merlin::vrpn
