// What VRPN servers offer in addition to what the configuration already reads, with the
// configuration entries for it, for people and for programs. Pure.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/settings.h"
#include "daemon/cli/devices/vrpn_servers.h"

namespace merlin::cli {

struct VrpnOffer {
  // One way to serve, as an entry of the configuration's list "devices".
  struct Use {
    std::string driver;
    std::string name;     // for the entry
    std::string read_by;  // the configured device that already reads it; empty: none does
  };

  std::string device;   // its name at the server
  vrpn::Measures sent;  // empty: its kind is not known
  std::vector<Use> uses;
};

struct VrpnListing {
  std::string port, version, fault;
  bool answers = false;
  bool own = false;  // it is merlind's own server, whose devices are no input and not listed
  std::vector<VrpnOffer> devices;
  std::size_t left_out = 0;  // devices that cannot be offered
};

// The offers in the servers' answers. A device that has sent nothing may serve as anything that its
// server describes. `instance`: the daemon that is not offered its own devices, in addition to that
// of `settings`. The names of the entries differ from those in `taken` and from each other.
std::vector<VrpnListing> listOffers(const std::vector<VrpnAnswer>& answers,
                                    const Settings& settings, const std::string& instance,
                                    std::vector<std::string> taken);

// "tracker, buttons"; for a device that has sent none of these, a text that its kind is not known.
std::string kindText(const vrpn::Measures& sent);

// The entry for the list "devices" of the configuration, as JSON and as a line of text.
nlohmann::ordered_json entryJson(const std::string& port, const VrpnOffer& offer,
                                 const VrpnOffer::Use& use);
std::string entryText(const std::string& port, const VrpnOffer& offer, const VrpnOffer::Use& use);

nlohmann::ordered_json toJson(const VrpnListing& listing);

// Lines for a person; for a server without an answer a single one, with the reason.
std::string toText(const VrpnListing& listing);

}  // namespace merlin::cli
