#include "daemon/cli/calibrate/calibrated_device.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "config/loader.h"
#include "daemon/base/files.h"
#include "daemon/cli/print.h"
#include "drivers/io/open_stream.h"
#include "drivers/registry.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

// Returns the list /devices for a configuration without one: merlind's default devices.
Json defaultList() {
  Json list = Json::array();
  for (const DeviceSettings& device : defaultDevices())
    list.push_back({{"name", device.name}, {"driver", device.line.driver}});
  return list;
}

// Reads a configuration; adds the list /devices if it is missing. A missing file is an empty
// configuration. Errors: kMalformed, kIo.
Result<Json> readConfiguration(const std::string& path) {
  Json config = Json::object();
  if (const auto file = FileCopy::read(path)) {
    config = Json::parse(file->text(), nullptr, false);
    if (!config.is_object())
      return Error{Errc::kMalformed,
                   path + ": exists and is not a JSON object; nothing was changed"};
  } else if (file.error().code != Errc::kNotFound) {
    return file.error();
  }
  Json& devices = config["devices"];
  if (devices.is_null()) devices = defaultList();
  if (devices.is_object())
    return Error{Errc::kMalformed,
                 fmt::format("{0}: /devices is an object, the form before devices had names; "
                             "nothing was changed: run `merlin config migrate {0}` first",
                             path)};
  if (!devices.is_array())
    return Error{Errc::kMalformed, path + ": /devices is not a list; nothing was changed"};
  return config;
}

std::string entryField(const Json& entry, const char* key) {
  const auto at = entry.find(key);
  return at != entry.end() && at->is_string() ? at->get<std::string>() : std::string();
}

std::optional<SampleKind> kindOf(const Json& entry) {
  const DriverEntry* const driver = findDriver(entryField(entry, "driver"));
  return driver ? std::optional(driver->kind) : std::nullopt;
}

std::string nameOf(const Json& entry) {
  std::string name = entryField(entry, "name");
  const auto kind = kindOf(entry);
  return name.empty() && kind ? kindName(*kind) : name;
}

// Returns the names of the devices of this kind, for a message about an unknown name, "its gloves:
// left, right".
std::string namesOf(const Json& list, SampleKind kind) {
  std::vector<std::string> names;
  for (const Json& entry : list) {
    if (kindOf(entry) == kind) names.push_back(nameOf(entry));
  }
  return names.empty() ? fmt::format("and no {} at all", kindName(kind))
                       : fmt::format("its {}s: {}", kindName(kind), fmt::join(names, ", "));
}

// Returns the index of the first device of this kind that has one of these drivers; nothing if
// there is none.
std::optional<std::size_t> firstOf(const Json& list, SampleKind kind, DriverNames drivers) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (kindOf(list[i]) == kind && isOneOf(entryField(list[i], "driver"), drivers)) return i;
  }
  return std::nullopt;
}

// Returns the index of the device named `name`, or of the first device of the kind if `name` is
// empty. `path`, `drivers`: for the message of the error. Errors: kInvalidArgument (there is no
// such device, or it is of another kind).
Result<std::size_t> indexOf(const Json& list, const std::string& path, SampleKind kind,
                            const std::string& name, DriverNames drivers = {}) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (name.empty() ? kindOf(list[i]) != kind : nameOf(list[i]) != name) continue;
    if (kindOf(list[i]) == kind) return i;
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: /devices/{} (\"{}\") has the driver \"{}\", which is not that of "
                             "a {}; {}",
                             path, i, name, entryField(list[i], "driver"), kindName(kind),
                             namesOf(list, kind))};
  }
  if (name.empty())
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: /devices has no {}: add one first (`merlin devices` shows what "
                             "is plugged in and the entry to add for it)",
                             path,
                             drivers.empty() ? kindName(kind)
                                             : fmt::format("device with the driver {}",
                                                           fmt::join(drivers, " or ")))};
  return Error{Errc::kInvalidArgument, fmt::format("{}: /devices has no device named \"{}\"; {}",
                                                   path, name, namesOf(list, kind))};
}

Result<CalibratedDevice> deviceAt(const Json& list, std::size_t index, const std::string& path) {
  const Json& entry = list[index];
  CalibratedDevice device{path,
                          fmt::format("/devices/{}", index),
                          nameOf(entry),
                          entryField(entry, "driver"),
                          Json::object(),
                          entry.value("baud", Json(0)),
                          entryField(entry, "port")};
  const auto own = entry.find(device.driver);
  if (own == entry.end()) return device;
  if (!own->is_object())
    return Error{Errc::kMalformed, fmt::format("{}: {}/{} is not an object; nothing was changed",
                                               path, device.pointer, device.driver)};
  device.own = *own;
  return device;
}

}  // namespace

bool isOneOf(const std::string& driver, DriverNames drivers) {
  return std::ranges::any_of(drivers, [&](const char* name) { return driver == name; });
}

Result<CalibratedDevice> findDevice(const std::string& file, SampleKind kind,
                                    const std::string& name, DriverNames drivers) {
  const auto config = readConfiguration(file);
  if (!config) return config.error();
  const Json& list = config->at("devices");
  const auto first = name.empty() ? firstOf(list, kind, drivers) : std::nullopt;
  if (first) return deviceAt(list, *first, file);
  const auto index = indexOf(list, file, kind, name, drivers);
  if (!index) return index.error();
  return deviceAt(list, *index, file);
}

// Only the entry of this device is given to the loader, so that faults elsewhere in the file do not
// stop the calibration.
Result<DeviceSettings> settingsOf(const CalibratedDevice& device, const std::string& port,
                                  int baud) {
  constexpr std::string_view kAlone = "/devices/0";
  const Json entry = {{"name", device.name},
                      {"driver", device.driver},
                      {"port", port},
                      {"baud", baud > 0 ? Json(baud) : device.baud},
                      {device.driver, device.own}};
  const LoadedSettings loaded = loadSettings(
      Json{{"devices", Json::array({entry})}}.dump(-1, ' ', true, Json::error_handler_t::replace),
      "");
  for (const Finding& finding : loaded.findings) {
    if (finding.adjusted) continue;
    const bool inside = finding.pointer.starts_with(kAlone);
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: {}{} {}", device.file, device.pointer,
                             inside ? finding.pointer.substr(kAlone.size()) : "", finding.what)};
  }
  return loaded.settings.devices.list.at(0);
}

Result<OwnLine> openOwnLine(const CalibratedDevice& device, const std::string& port, int baud) {
  const std::string& at = port.empty() ? device.port : port;
  if (at.empty())
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: {} (\"{}\") has no port: give one on the command line; `merlin "
                             "devices` lists what is plugged in",
                             device.file, device.pointer, device.name)};
  const auto address = parsePort(at);
  if (!address) return address.error();
  auto settings = settingsOf(device, at, baud);
  if (!settings) return settings.error();
  auto stream = io::openPort(*address, settings->line.baud);
  if (!stream) return stream.error();
  return OwnLine{*std::move(settings), *std::move(stream)};
}

Result<Ok> saveSettings(const CalibratedDevice& device, SampleKind kind, const Json& values) {
  auto config = readConfiguration(device.file);
  if (!config) return config.error();
  Json& list = (*config)["devices"];
  const auto index = indexOf(list, device.file, kind, device.name);
  if (!index) return index.error();
  const auto now = deviceAt(list, *index, device.file);
  if (!now) return now.error();
  if (now->driver != device.driver)
    return Error{
        Errc::kInvalidArgument,
        fmt::format("{}: the driver of {} has changed meanwhile from {} to {}; nothing was "
                    "changed: calibrate again",
                    device.file, now->pointer, device.driver, now->driver)};
  Json& own = list[*index][device.driver];
  if (own.is_null()) own = Json::object();
  own.update(values);
  return writeFile(device.file, config->dump(2) + "\n");
}

Result<Ok> saveChecked(const CalibratedDevice& device, SampleKind kind, const Json& values) {
  CalibratedDevice changed = device;
  changed.own.update(values);
  if (const auto allowed = settingsOf(changed, device.port, 0); !allowed) return allowed.error();
  const auto saved = saveSettings(device, kind, values);
  if (saved)
    printOut("{}: {}, {}; run `merlin reload` or restart merlind to apply it\n", device.file,
             device.name, values.dump());
  return saved;
}

void addDeviceOption(Command command, std::string& name, const char* kind) {
  const std::string help =
      fmt::format("Name of the {0} in the configuration file; the default is its first {0}", kind);
  command.option("--device", name, help.c_str()).typeName("NAME");
}

}  // namespace merlin::cli
