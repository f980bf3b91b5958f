// Lists the devices of VRPN servers with the configuration entries for those that the configuration
// does not read yet, for people and for programs. Pure.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/settings.h"
#include "daemon/cli/devices/vrpn_servers.h"

namespace merlin::cli {

// A device of a VRPN server, and how MERLIN can read it.
struct VrpnOffer {
  // One way to read the device, as an entry of the list "devices" of the configuration.
  struct Use {
    std::string driver;
    std::string name;     // name for the entry
    std::string read_by;  // the configured device that already reads it; empty: none does
  };

  std::string device;   // its name on the server
  vrpn::Measures sent;  // the kinds of data that it has sent; none: its kind is not known
  std::vector<Use> uses;
};

// What one VRPN server offers, or why it does not.
struct VrpnListing {
  std::string port, version, fault;
  bool answers = false;
  // True: it is merlind's own server, whose devices are not input and are not listed.
  bool own = false;
  std::vector<VrpnOffer> devices;
  std::size_t left_out = 0;  // number of further devices, which cannot be offered
};

// Converts the servers' answers to listings, one for each. A device that has sent nothing is
// offered as every kind that its server describes. The devices of a server that belongs to merlind
// itself (with the name `instance` or that in `settings`) are not listed. The names of the entries
// differ from each other and from those in `taken`.
std::vector<VrpnListing> listOffers(const std::vector<VrpnAnswer>& answers,
                                    const Settings& settings, const std::string& instance,
                                    std::vector<std::string> taken);

// Returns the kinds of data as a text, "tracker, buttons"; if there are none, a text that the kind
// is not known.
std::string kindText(const vrpn::Measures& sent);

// Return the entry for the list "devices" of the configuration, as JSON and as a line of JSON text.
nlohmann::ordered_json entryJson(const std::string& port, const VrpnOffer& offer,
                                 const VrpnOffer::Use& use);
std::string entryText(const std::string& port, const VrpnOffer& offer, const VrpnOffer::Use& use);

nlohmann::ordered_json toJson(const VrpnListing& listing);

// Returns lines for a person; a single line with the reason if the server has not answered.
std::string toText(const VrpnListing& listing);

}  // namespace merlin::cli
