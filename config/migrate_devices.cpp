#include "config/migrate_devices.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "drivers/registry.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;
using Notes = std::vector<std::string>;

// One of the three devices of an earlier version. The settings of `driver` were in the device's
// object itself, those of the drivers `others` in groups inside it.
struct FormerDevice {
  const char* key;  // key in /devices, and the device's name in the list
  const char* driver;
  std::span<const char* const> others;
};

constexpr const char* kOtherTrackers[] = {"vrpn"};
constexpr const char* kOtherBalls[] = {"spacenav", "evdev"};
constexpr FormerDevice kFormerDevices[] = {{"glove", "cyberglove", {}},
                                           {"tracker", "fastrak", kOtherTrackers},
                                           {"ball", "spaceball", kOtherBalls}};
constexpr const char* kLineKeys[] = {"port", "baud", "max_bytes_s"};

// A setting that moved from /devices/WAS to /GROUP/NOW.
struct MovedKey {
  const char* was;
  const char* group;
  const char* now;
};
constexpr MovedKey kMovedKeys[] = {
    {"postures", "postures", "file"},           {"posture_hold_s", "postures", "hold_s"},
    {"posture_leave_s", "postures", "leave_s"}, {"posture_margin", "postures", "margin"},
    {"posture_drift", "postures", "drift"},     {"stale_after_s", "people", "stale_after_s"}};

// Settings of /devices that moved to the root without a change, in the order of written files.
constexpr const char* kKeptKeys[] = {"bindings",           "people",         "gpio",  "projectors",
                                     "projector_schedule", "cpu_latency_us", "script"};

bool contains(std::span<const char* const> names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

Error notAnObject(const std::string& key) {
  return {Errc::kInvalidArgument, fmt::format("/devices/{} is not an object", key)};
}

std::string keysOf(const Json& object) {
  std::string keys;
  for (const auto& [key, value] : object.items()) keys += (keys.empty() ? "" : ", ") + key;
  return keys;
}

// Returns the drivers' settings in the object of a device, as an object of groups with the drivers'
// names.
Json ownSettings(const FormerDevice& former, const Json& old) {
  Json own = Json::object();
  for (const auto& [key, value] : old.items()) {
    if (key == "driver" || contains(kLineKeys, key)) continue;
    if (contains(former.others, key))
      own[key] = value;
    else
      own[former.driver][key] = value;
  }
  return own;
}

Json entryOf(const FormerDevice& former, const Json& old, Notes& notes) {
  Json entry = {{"name", former.key}, {"driver", old.value("driver", Json(former.driver))}};
  for (const char* const key : kLineKeys) {
    if (old.contains(key)) entry[key] = old[key];
  }
  // An unknown driver is kept with all settings, so that the loader reports it.
  const std::string driver =
      entry["driver"].is_string() ? entry["driver"].get<std::string>() : std::string();
  const bool known = findDriver(driver) != nullptr;
  const Json own = ownSettings(former, old);
  for (const auto& [name, settings] : own.items()) {
    if (!known || name == driver) {
      entry[name] = settings;
      continue;
    }
    notes.push_back(fmt::format(
        "/devices/{}: the settings of the driver {} ({}) are left out, since the device's driver "
        "is {}",
        former.key, name, settings.is_object() ? keysOf(settings) : settings.dump(), driver));
  }
  return entry;
}

// Returns the list of devices; an empty list if the file names none, because it then has the
// default devices, in this version too.
Result<Json> deviceList(const Json& old, Notes& notes) {
  Json list = Json::array();
  std::string missing;
  for (const FormerDevice& former : kFormerDevices) {
    if (!old.contains(former.key))
      missing += (missing.empty() ? "" : ", ") + std::string(former.key);
    const Json device = old.value(former.key, Json::object());
    if (!device.is_object()) return notAnObject(former.key);
    list.push_back(entryOf(former, device, notes));
  }
  const bool none = std::ranges::none_of(
      kFormerDevices, [&](const FormerDevice& former) { return old.contains(former.key); });
  if (none) return Json::array();
  if (!missing.empty()) {
    notes.push_back(fmt::format(
        "/devices: the list has entries without a port for what the file did not name ({}); a list "
        "in a file of conf.d replaces that of the files before it, so it must name all devices",
        missing));
  }
  return list;
}

// Returns the settings that replace the object `old`, in the order of written files.
Result<Json> replacement(const Json& old, Notes& notes) {
  auto list = deviceList(old, notes);
  if (!list) return list.error();
  Json now = Json::object();
  if (!list->empty()) now["devices"] = *std::move(list);
  if (old.contains("hand")) {
    if (!old["hand"].is_object()) return notAnObject("hand");
    Json hand = {{"name", "hand"}};
    hand.update(old["hand"]);
    now["hands"] = Json::array({std::move(hand)});
  }
  const auto move = [&](const std::string& group) {
    for (const MovedKey& moved : kMovedKeys) {
      if (moved.group == group && old.contains(moved.was)) now[group][moved.now] = old[moved.was];
    }
  };
  move("postures");
  for (const char* const key : kKeptKeys) {
    if (old.contains(key)) now[key] = old[key];
    move(key);
  }
  // Unknown settings are kept, so that the loader reports them.
  for (const auto& [key, value] : old.items()) {
    const bool moved =
        key == "hand" || contains(kKeptKeys, key) ||
        std::ranges::any_of(kMovedKeys, [&k = key](const MovedKey& m) { return k == m.was; }) ||
        std::ranges::any_of(kFormerDevices,
                            [&k = key](const FormerDevice& f) { return k == f.key; });
    if (!moved) now[key] = value;
  }
  return now;
}

}  // namespace

Result<bool> moveDevices(Json& root, Notes& notes) {
  const auto devices = root.find("devices");
  if (devices == root.end() || !devices->is_object()) return false;
  Notes added;
  const auto now = replacement(*devices, added);
  if (!now) return now.error();
  Json moved = Json::object();
  for (const auto& [key, value] : root.items()) {
    if (key != "devices") {
      moved[key] = value;
      continue;
    }
    for (const auto& [new_key, new_value] : now->items()) {
      if (new_key != "devices" && root.contains(new_key)) {
        return Error{Errc::kInvalidArgument,
                     fmt::format("has both the object /devices, from which /{0} is made, and /{0}: "
                                 "merge them by hand",
                                 new_key)};
      }
      moved[new_key] = new_value;
    }
  }
  root = std::move(moved);
  notes.insert(notes.end(), added.begin(), added.end());
  return true;
}

}  // namespace merlin
