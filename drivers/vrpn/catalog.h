// Catalog: lists the devices that a VRPN server describes to a client, and what they measure, as
// far as their messages show it. Pure.
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

// The kinds of VRPN messages that MERLIN reads.
struct Measures {
  bool poses = false, buttons = false, channels = false;

  bool any() const noexcept { return poses || buttons || channels; }
};

// VRPN does not say what kind a device is: a device may send messages of several types. `sent`
// contains only the types of which a message has arrived, and a device at rest may send none.
struct CatalogDevice {
  std::string name;  // valid in a configuration: 1 to 99 bytes of text (isText()), no '@'
  Measures sent;
};

// Keeps at most kMostDevices devices, whatever the server sends.
class Catalog {
 public:
  static constexpr std::size_t kMostDevices = 64;

  // Takes the next bytes from the server, its greeting first. Errors: kMalformed (not a server of
  // VRPN 7, or a message with an invalid length), kClosed (the server ends the connection). After
  // an error take() must not be called again; earlier devices remain.
  Result<Ok> take(std::string_view bytes);

  bool greeted() const noexcept { return greeting_.size() == kVrpnCookieLength; }
  // Returns the server's version, such as "07.38"; empty before the greeting. The bytes come from
  // the server unchecked.
  std::string_view version() const;
  // Returns the devices in the order in which they were described, without VRPN's internal senders.
  const std::vector<CatalogDevice>& devices() const noexcept { return devices_; }
  // Returns the number of devices that were left out because their name is not valid in a
  // configuration or because there were too many.
  std::size_t leftOut() const noexcept { return left_out_; }
  // Returns the types of messages that the server has described; any of its devices may send them.
  const Measures& described() const noexcept { return described_; }
  // Returns the instance of MERLIN that runs the server; empty if it is not a server of MERLIN.
  const std::string& instance() const noexcept { return instance_; }

 private:
  void handle(const Message& message);
  void describeSender(std::int32_t number, std::string_view name);
  void describeType(std::int32_t number, std::string_view name);
  CatalogDevice* named(std::string_view name);

  std::string greeting_;
  Parser parser_;
  std::vector<CatalogDevice> devices_;
  // Maps a server's number to an index in devices_.
  std::map<std::int32_t, std::size_t> senders_;
  std::map<std::int32_t, bool Measures::*> types_;  // maps a server's number to a kind
  Measures described_;
  std::string instance_;
  std::size_t left_out_ = 0;
};

}  // namespace merlin::vrpn
