#include "daemon/cli/devices/vrpn_offers.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "config/device_checks.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/devices/plugged.h"
#include "daemon/cli/print.h"
#include "drivers/port/port_address.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

// A driver that reads devices of VRPN servers: a name for such a device, and which kinds of data
// the driver can use.
struct Reader {
  const char *driver, *name;
  bool (*reads)(const vrpn::Measures&);
  const std::string& (*device)(const DriverSettings&);  // returns the device that the settings name
};
constexpr Reader kReaders[] = {
    {"vrpn", "tracker", [](const vrpn::Measures& m) { return m.poses; },
     [](const DriverSettings& s) -> const std::string& { return s.vrpn.device; }},
    {"vrpn_pad", "pad", [](const vrpn::Measures& m) { return m.buttons || m.channels; },
     [](const DriverSettings& s) -> const std::string& { return s.vrpn_pad.device; }},
};

// Returns the name of the configured device that already reads this device of the server with this
// driver; empty if none does.
std::string readBy(const PortAddress& server, const std::string& device, const Reader& reader,
                   const DevicesSettings& devices) {
  for (const DeviceSettings& d : devices.list) {
    const auto port = parsePort(d.line.port);
    if (d.line.driver == reader.driver && port && sameLine(*port, server) &&
        reader.device(d.own) == device)
      return d.name;
  }
  return {};
}

VrpnOffer offerOf(const vrpn::CatalogDevice& device, const vrpn::Catalog& catalog,
                  const PortAddress& server, const DevicesSettings& devices) {
  VrpnOffer offer{device.name, device.sent, {}};
  const vrpn::Measures& may = device.sent.any() ? device.sent : catalog.described();
  for (const Reader& reader : kReaders) {
    std::string read_by = readBy(server, device.name, reader, devices);
    if (reader.reads(may) || !read_by.empty())
      offer.uses.push_back({reader.driver, reader.name, std::move(read_by)});
  }
  return offer;
}

VrpnListing listingOf(const VrpnAnswer& answer, const Settings& settings,
                      const std::string& instance) {
  const vrpn::Catalog& catalog = answer.catalog;
  VrpnListing listing;
  listing.port = answer.port;
  listing.fault = answer.fault;
  listing.answers = catalog.greeted() && (answer.fault.empty() || !catalog.devices().empty());
  const auto server = parsePort(answer.port);
  if (!server || !listing.answers) return listing;
  listing.version = oneLine(catalog.version());
  const bool of_instance = !catalog.instance().empty() && (catalog.instance() == instance ||
                                                           catalog.instance() == settings.instance);
  listing.own = of_instance || isOwnVrpnServer(*server, settings.serve);
  if (listing.own) return listing;
  listing.left_out = catalog.leftOut();
  for (const vrpn::CatalogDevice& device : catalog.devices())
    listing.devices.push_back(offerOf(device, catalog, *server, settings.devices));
  return listing;
}

std::string quoted(const std::string& text) { return jsonText(Json(text)); }

std::string deviceText(const VrpnListing& listing, const VrpnOffer& offer) {
  std::string text = fmt::format("    {}: {}\n", offer.device, kindText(offer.sent));
  for (const VrpnOffer::Use& use : offer.uses) {
    text += use.read_by.empty() ? fmt::format("      {}\n", entryText(listing.port, offer, use))
                                : fmt::format("      is read by \"{}\"\n", use.read_by);
  }
  return text +
         (offer.uses.empty() ? "      the server describes nothing that MERLIN reads\n" : "");
}

}  // namespace

std::vector<VrpnListing> listOffers(const std::vector<VrpnAnswer>& answers,
                                    const Settings& settings, const std::string& instance,
                                    std::vector<std::string> taken) {
  std::vector<VrpnListing> all;
  for (const VrpnAnswer& answer : answers) {
    VrpnListing& listing = all.emplace_back(listingOf(answer, settings, instance));
    for (VrpnOffer& offer : listing.devices) {
      for (VrpnOffer::Use& use : offer.uses) {
        use.name = freeName(use.name, taken);
        if (use.read_by.empty()) taken.push_back(use.name);
      }
    }
  }
  return all;
}

std::string kindText(const vrpn::Measures& sent) {
  std::vector<const char*> kinds;
  if (sent.poses) kinds.push_back("tracker");
  if (sent.buttons) kinds.push_back("buttons");
  if (sent.channels) kinds.push_back("analog");
  return kinds.empty() ? "its kind is not known: it has sent nothing that MERLIN reads"
                       : fmt::format("{}", fmt::join(kinds, ", "));
}

Json entryJson(const std::string& port, const VrpnOffer& offer, const VrpnOffer::Use& use) {
  return {{"name", use.name},
          {"driver", use.driver},
          {"port", port},
          {use.driver, {{"device", offer.device}}}};
}

std::string entryText(const std::string& port, const VrpnOffer& offer, const VrpnOffer::Use& use) {
  return fmt::format(R"({{"name": {}, "driver": {}, "port": {}, {}: {{"device": {}}}}})",
                     quoted(use.name), quoted(use.driver), quoted(port), quoted(use.driver),
                     quoted(offer.device));
}

Json toJson(const VrpnListing& listing) {
  Json devices = Json::array();
  for (const VrpnOffer& offer : listing.devices) {
    Json entries = Json::array(), readers = Json::array();
    for (const VrpnOffer::Use& use : offer.uses) {
      if (use.read_by.empty())
        entries.push_back(entryJson(listing.port, offer, use));
      else
        readers.push_back(use.read_by);
    }
    devices.push_back({{"name", offer.device},
                       {"tracker", offer.sent.poses},
                       {"buttons", offer.sent.buttons},
                       {"analog", offer.sent.channels},
                       {"read_by", std::move(readers)},
                       {"as", std::move(entries)}});
  }
  return {{"port", listing.port},        {"answers", listing.answers},
          {"version", listing.version},  {"reason", listing.fault},
          {"own", listing.own},          {"devices", std::move(devices)},
          {"left_out", listing.left_out}};
}

std::string toText(const VrpnListing& listing) {
  if (!listing.answers) return fmt::format("  {}: {}\n", listing.port, listing.fault);
  if (listing.own) {
    return fmt::format(
        "  {}: merlind's own server (/serve/vrpn_port), which merlind does not read\n",
        listing.port);
  }
  std::string text = fmt::format("  {}, VRPN {}{}\n", listing.port, listing.version,
                                 listing.devices.empty() ? ": no device" : "");
  for (const VrpnOffer& offer : listing.devices) text += deviceText(listing, offer);
  if (listing.left_out > 0) {
    text += fmt::format(
        "    {} more devices are not listed: their names cannot be used in a configuration, or "
        "there are too many\n",
        listing.left_out);
  }
  if (!listing.fault.empty()) text += fmt::format("    {}\n", listing.fault);
  return text;
}

}  // namespace merlin::cli
