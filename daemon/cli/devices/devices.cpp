// merlin devices: lists the devices that a running merlind reads, and devices that are plugged into
// this machine or offered by VRPN servers but not configured.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

#include "config/loader.h"
#include "config/usual_file.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/command.h"
#include "daemon/cli/devices/live_table.h"
#include "daemon/cli/devices/plugged.h"
#include "daemon/cli/devices/vrpn_offers.h"
#include "daemon/cli/devices/vrpn_servers.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/shm/segment.h"
#include "drivers/port/port_address.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRedraw_ms = 100;
// Time to wait for the answers of all servers.
constexpr Duration kVrpnWait = std::chrono::milliseconds(500);

struct DevicesOptions {
  std::string instance = "merlin", config;
  std::vector<std::string> vrpn;
  bool json = false, watch = false;
  double seconds = 0;
};

struct Configured {
  std::string name, state;
  DeviceHealth health;
  // Device file of its port, with links resolved; empty: the port is no file.
  std::string path;
};

std::string pathOf(const std::string& port) {
  const auto address = parsePort(port);
  if (!address || address->kind == PortKind::kTcp || address->kind == PortKind::kUdp) return {};
  std::error_code error;
  const auto real = std::filesystem::canonical(address->path, error);
  return error ? address->path : real.string();
}

// Returns the devices of a running merlind. Errors: those of DevicesReader::open(); kNotFound (it
// has ended).
Result<std::vector<Configured>> configuredDevices(const std::string& instance) {
  const std::string segment = shm::segmentName(instance, "devices");
  const auto reader = shm::DevicesReader::open(segment);
  if (!reader) return reader.error();
  const Timestamp now = SystemClock().now();
  if (!shm::isRunning(segment, *(**reader).header, now))
    return Error{Errc::kNotFound, "it has ended"};
  std::vector<Configured> all;
  for (const auto& [device, slot] : (*reader)->health) {
    const auto health = slot->read();
    if (health)
      all.push_back({device, shm::healthName(*health, now), *health, pathOf(health->port)});
  }
  return all;
}

// Returns the configured device that reads the plugged-in one; null if none does.
const Configured* readerOf(const Plugged& plugged, const std::vector<Configured>& configured) {
  const auto at = std::ranges::find(configured, plugged.path, &Configured::path);
  return at == configured.end() ? nullptr : &*at;
}

void printConfigured(const std::vector<Configured>& configured) {
  for (const Configured& device : configured) {
    const DeviceHealth& h = device.health;
    const bool works = device.state == "ok";
    const std::string what = works ? fmt::format("{:.1f} Hz  {}{}{}", h.rate_hz, h.identity,
                                                 h.reason[0] ? "; " : "", h.reason)
                                   : h.reason;
    printOut("  {:10} {:8} {}{}{}\n", device.name, device.state, h.port, h.port[0] ? "  " : "",
             what);
  }
}

// Returns `title` and the words, separated by commas, in indented lines of at most 90 characters.
std::string wrapped(const std::string& title, const std::vector<std::string>& words) {
  constexpr std::size_t kWidth = 90;
  std::string text, line = "    " + title;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = " " + words[i] + (i + 1 < words.size() ? "," : "");
    if (line.size() + word.size() > kWidth) {
      text += line + "\n";
      line = "     ";
    }
    line += word;
  }
  return text + line + "\n";
}

void printPlugged(const Plugged& plugged, const Configured* reader) {
  printOut("  {}: {}\n", plugged.kind, plugged.name);
  if (reader) printOut("    is the port of \"{}\"\n", reader->name);
  if (!plugged.axes.empty()) printOut("{}", wrapped("axes:", plugged.axes));
  if (!plugged.keys.empty()) printOut("{}", wrapped("keys:", plugged.keys));
  if (!plugged.usual.empty()) printOut("    by default: {}\n", plugged.usual);
  if (reader) return;
  for (const Plugged::Use& use : plugged.uses)
    printOut("    {}\n", configurationEntry(plugged, use));
  if (!plugged.readable) {
    printOut("    this user may not open it{}\n",
             plugged.group.empty() ? "" : fmt::format("; its group is {}", plugged.group));
  }
}

Json jsonOf(const Configured& device) {
  return {{"name", device.name},
          {"health", device.state},
          {"port", device.health.port},
          {"identity", device.health.identity},
          {"reason", device.health.reason},
          {"rate_hz", device.health.rate_hz},
          {"samples", device.health.samples},
          {"reconnects", device.health.reconnects}};
}

Json jsonOf(const Plugged& plugged, const Configured* reader) {
  Json entries = Json::array();
  for (const Plugged::Use& use : plugged.uses)
    entries.push_back({{"name", use.name}, {"driver", use.driver}, {"port", plugged.port}});
  return {{"kind", plugged.kind},         {"name", plugged.name},
          {"port", plugged.port},         {"read_by", reader ? Json(reader->name) : Json()},
          {"readable", plugged.readable}, {"group", plugged.group},
          {"axes", plugged.axes},         {"keys", plugged.keys},
          {"usual", plugged.usual},       {"as", std::move(entries)}};
}

// Returns the settings of the file that the option names; without the option, those of the usual
// file or, if that is missing or invalid, the defaults. Errors: kInvalidArgument (the named file is
// invalid).
Result<Settings> settingsOf(const DevicesOptions& options) {
  if (options.config.empty() && !fileStamp(kUsualConfig)) return Settings{};
  const std::string file = options.config.empty() ? kUsualConfig : options.config;
  const LoadedSettings loaded = loadSettingsFile(file);
  if (loaded.verdict() != LoadedSettings::Verdict::kInvalid) return loaded.settings;
  const std::string what = fmt::format(
      "{0}: the configuration is invalid or cannot be read; merlind --check-config {0} says why",
      file);
  if (!options.config.empty()) return Error{Errc::kInvalidArgument, what};
  printNote(what + ", so the VRPN servers that it names are not asked");
  return Settings{};
}

// Returns the names of running and configured devices that have a port. The name of an entry
// without a port stays free, because a plugged-in device may use that entry.
std::vector<std::string> takenNames(const std::vector<Configured>& running,
                                    const Settings& settings) {
  std::vector<std::string> taken;
  for (const Configured& device : running) {
    if (device.health.port[0]) taken.push_back(device.name);
  }
  for (const DeviceSettings& device : settings.devices.list) {
    if (!device.line.port.empty()) taken.push_back(device.name);
  }
  return taken;
}

// Adds to `devices` the devices of VRPN servers that the running merlind reads or has read since
// its start.
void addRunning(const std::vector<Configured>& running, DevicesSettings& devices) {
  for (const Configured& device : running) {
    if (auto reads = vrpnDeviceOf(device.name, device.health.port, device.health.identity))
      devices.list.push_back(*std::move(reads));
  }
}

// What is plugged in and what VRPN servers offer; the names suggested for entries are not in use.
struct Found {
  std::vector<Plugged> plugged;
  std::vector<VrpnListing> vrpn;
};

Result<Found> findBeside(const std::vector<Configured>& running, const DevicesOptions& options) {
  const auto loaded = settingsOf(options);
  if (!loaded) return loaded.error();
  Settings settings = *loaded;
  addRunning(running, settings.devices);
  std::vector<std::string> taken = takenNames(running, settings), servers;
  for (const std::string& text : options.vrpn) servers.push_back(*vrpnPort(text));
  Found found;
  found.plugged = findPlugged();
  nameApart(found.plugged, taken);
  for (const Plugged& plugged : found.plugged) {
    for (const Plugged::Use& use : plugged.uses) taken.push_back(use.name);
  }
  const auto answers = askServers(serversToAsk(settings.devices, servers), kVrpnWait);
  found.vrpn = listOffers(answers, settings, options.instance, taken);
  return found;
}

void printFoundJson(bool running, const std::vector<Configured>& configured, const Found& found) {
  Json json = {{"running", running},
               {"configured", Json::array()},
               {"plugged", Json::array()},
               {"vrpn_servers", Json::array()}};
  for (const Configured& device : configured) json["configured"].push_back(jsonOf(device));
  for (const Plugged& plugged : found.plugged)
    json["plugged"].push_back(jsonOf(plugged, readerOf(plugged, configured)));
  for (const VrpnListing& listing : found.vrpn) json["vrpn_servers"].push_back(toJson(listing));
  printJsonLine(json);
}

int list(const DevicesOptions& options) {
  const auto running = configuredDevices(options.instance);
  const std::vector<Configured> configured = running ? *running : std::vector<Configured>();
  const auto found = findBeside(configured, options);
  if (!found) return fail(found.error());
  if (options.json) {
    printFoundJson(running.ok(), configured, *found);
    return kExitDone;
  }
  if (running)
    printOut("Devices of merlind \"{}\":\n", options.instance);
  else
    printOut("No merlind with devices runs as \"{}\".\n", options.instance);
  printConfigured(configured);
  printOut("{}\n", found->plugged.empty()
                       ? "Nothing is plugged in that could be a device."
                       : "Plugged in, with the entry for the configuration's list \"devices\":");
  for (const Plugged& plugged : found->plugged)
    printPlugged(plugged, readerOf(plugged, configured));
  printOut(
      "VRPN servers, with the entry for each device that is not configured (others are asked by "
      "--vrpn HOST):\n");
  for (const VrpnListing& listing : found->vrpn) printOut("{}", toText(listing));
  return kExitDone;
}

// Prints the devices' current values ten times a second until a signal or for options.seconds. On a
// terminal, each table replaces the one before.
int watch(const DevicesOptions& options) {
  const UniqueFd stop = stopSignals();
  const std::string segment = shm::segmentName(options.instance, "devices");
  const auto reader = shm::DevicesReader::open(segment);
  if (!reader && reader.error().code == Errc::kNotFound) {
    return fail({Errc::kNotFound,
                 fmt::format("no merlind with devices runs as \"{}\": start it first, or give "
                             "--instance",
                             options.instance)});
  }
  if (!reader) return fail(reader.error());
  const SystemClock clock;
  const Timestamp began = clock.now();
  const bool terminal = ::isatty(STDOUT_FILENO) == 1;
  while (options.seconds <= 0 || toSeconds(clock.now() - began) < options.seconds) {
    if (!shm::isRunning(segment, *(**reader).header, clock.now()))
      return fail({Errc::kClosed, "merlind has ended"});
    if (terminal) fmt::print("\x1b[H\x1b[J");
    printOut("{}\n", liveTable(**reader, clock.now()));
    std::fflush(stdout);
    pollfd item{stop.get(), POLLIN, 0};
    if (::poll(&item, 1, kRedraw_ms) > 0) break;
  }
  return kExitDone;
}

}  // namespace

void addDevices(Command app, Run& run) {
  const auto options = std::make_shared<DevicesOptions>();
  Command command = app.subcommand(
      "devices",
      "List the devices that merlind reads and how they are, and what is plugged into this machine "
      "and not configured (serial adapters, gamepads, space mice, clickers, touch screens), with "
      "the entry for the configuration's list \"devices\" that makes it a device, and the axes and "
      "keys of input devices by the names that the configuration uses. No device is opened. VRPN "
      "servers are asked for their devices: that of this machine at port 3883, those that the "
      "configuration names, those that merlind reads and those of --vrpn, for half a second.\n"
      "Example: merlin devices; merlin devices --vrpn lab; merlin devices --watch");
  addInstance(command, options->instance);
  command
      .option(
          "-c,--config", options->config,
          "The configuration whose VRPN servers are asked and whose devices are not offered "
          "again, beside those of the running merlind; /etc/merlin/merlin.json if none is named")
      .typeName("FILE");
  command.option("--vrpn", options->vrpn, "Another VRPN server that is asked; may be repeated")
      .typeName("HOST[:PORT]")
      .repeatable()
      .check([](const std::string& text) {
        return vrpnPort(text) ? "" : excerpt(text) + " is neither HOST nor HOST:PORT";
      });
  command.flag("--json", options->json, "Print one JSON document");
  command.flag(
      "--watch", options->watch,
      "Show what the devices measure, ten times a second, until interrupted; axes, buttons "
      "and keys by the names that bindings use");
  command.option("--for", options->seconds, "With --watch: duration in seconds").seconds();
  command.callback([options, &run] {
    run = [options] { return options->watch ? watch(*options) : list(*options); };
  });
}

}  // namespace merlin::cli
