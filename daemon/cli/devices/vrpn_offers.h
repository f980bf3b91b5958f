// What VRPN servers offer beside what the configuration already reads, with the entries for it, for
// people and for programs. Pure.
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
    std::string read_by;  // the configured device that it is already; empty: none is
  };

  std::string device;   // its name at the server
  vrpn::Measures sent;  // nothing: its kind is not known
  std::vector<Use> uses;
};

struct VrpnListing {
  std::string port, version, fault;
  bool answers = false;
  bool own = false;  // it is merlind's own, whose devices are no input: none is listed
  std::vector<VrpnOffer> devices;
  std::size_t left_out = 0;  // devices that cannot be offered
};

// What the servers answered. A device that has sent nothing may be all that its server describes.
// `instance`: of the daemon that is not offered its own devices, beside that of `settings`. The
// names of the entries differ from those in `taken` and from each other.
std::vector<VrpnListing> listOffers(const std::vector<VrpnAnswer>& answers,
                                    const Settings& settings, const std::string& instance,
                                    std::vector<std::string> taken);

// "tracker, buttons"; of a device that has sent nothing of these, that it is not known.
std::string kindText(const vrpn::Measures& sent);

// The entry for the list "devices" of the configuration, as JSON and as a line of text.
nlohmann::ordered_json entryJson(const std::string& port, const VrpnOffer& offer,
                                 const VrpnOffer::Use& use);
std::string entryText(const std::string& port, const VrpnOffer& offer, const VrpnOffer::Use& use);

nlohmann::ordered_json toJson(const VrpnListing& listing);

// Lines for a person: of a server without an answer one, with the reason.
std::string toText(const VrpnListing& listing);

}  // namespace merlin::cli
