#include "config/migrate.h"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/migrate_devices.h"
#include "daemon/json/json_tree.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;
using Notes = std::vector<std::string>;

// Returns whether `object` is a JSON object whose member `key` is a non-empty string.
bool hasText(const Json& object, const char* key) {
  const auto found = object.find(key);
  return object.is_object() && found != object.end() && found->is_string() &&
         !found->get_ref<const std::string&>().empty();
}

// Converts the group /wall/png of earlier versions to an output of kind png in /wall/outputs; a
// group without a path is removed. Errors: kInvalidArgument (the file has /wall/outputs too).
Result<bool> movePng(Json& root, Notes&) {
  const auto wall = root.find("wall");
  if (wall == root.end() || !wall->is_object() || !wall->contains("png")) return false;
  if (wall->contains("outputs")) {
    return Error{Errc::kInvalidArgument,
                 "/wall has both png and outputs: move the path into /wall/outputs by hand"};
  }
  const Json png = (*wall)["png"];
  wall->erase("png");
  if (!hasText(png, "path")) return true;
  Json output = {{"kind", "png"}};
  output.update(png);
  (*wall)["outputs"] = Json::array({Json{{"kind", "shared_memory"}}, std::move(output)});
  return true;
}

// Returns the group `key` of `parent`; adds an empty group if it is missing. `pointer`: the group's
// JSON pointer, for the error. Errors: kInvalidArgument (it is not an object).
Result<Json*> groupOf(Json& parent, const char* key, const char* pointer) {
  if (!parent.contains(key)) parent[key] = Json::object();
  Json& group = parent[key];
  if (!group.is_object())
    return Error{Errc::kInvalidArgument, fmt::format("{} is not an object", pointer)};
  return &group;
}

// Removes /wall/scene/KEY and returns its value; null if it does not exist. Also removes
// /wall/scene if it is empty afterwards.
Json takeOfScene(Json& root, const char* key) {
  const auto wall = root.find("wall");
  if (wall == root.end() || !wall->is_object() || !wall->contains("scene")) return nullptr;
  Json& scene = (*wall)["scene"];
  if (!scene.is_object() || !scene.contains(key)) return nullptr;
  Json value = scene[key];
  scene.erase(key);
  if (scene.empty()) wall->erase("scene");
  return value;
}

Error bothForms(const char* was, const char* now) {
  return {Errc::kInvalidArgument,
          fmt::format("has both {} and {}: delete the former by hand", was, now)};
}

bool hasPanel(const Json& devices) {
  const auto gpio = devices.find("gpio");
  return gpio != devices.end() && hasText(*gpio, "chip");
}

// Moves /wall/scene/bindings to /devices/bindings. In earlier versions the button of the panel
// needed no binding for its default action next_mode, so a file with a panel gets this binding.
Result<bool> moveBindings(Json& root, Notes&) {
  Json bindings = takeOfScene(root, "bindings");
  if (bindings.is_null()) return false;
  const auto devices = groupOf(root, "devices", "/devices");
  if (!devices) return devices.error();
  if ((*devices)->contains("bindings"))
    return bothForms("/wall/scene/bindings", "/devices/bindings");
  const bool button = (*devices)->contains("gpio") && (**devices)["gpio"].is_object() &&
                      (**devices)["gpio"].contains("button_command");
  if (bindings.is_array() && hasPanel(**devices) && !button)
    bindings.push_back({{"input", "panel.button"}, {"action", "next_mode"}});
  (**devices)["bindings"] = std::move(bindings);
  return true;
}

Result<bool> moveButton(Json& root, Notes&) {
  const auto devices = root.find("devices");
  if (devices == root.end() || !devices->is_object() || !devices->contains("gpio")) return false;
  Json& gpio = (*devices)["gpio"];
  if (!gpio.is_object() || !gpio.contains("button_command")) return false;
  const Json command = gpio["button_command"];
  gpio.erase("button_command");
  Json& bindings = (*devices)["bindings"];
  if (bindings.is_null()) {  // the file had the default bindings of that version
    bindings = Json::array({{{"input", "posture.fist"}, {"action", "grab"}},
                            {{"input", "ball.button.1"}, {"action", "reset_view"}},
                            {{"input", "ball.button.2"}, {"action", "next_mode"}}});
  }
  if (bindings.is_array()) bindings.push_back({{"input", "panel.button"}, {"action", command}});
  return true;
}

Result<bool> moveStation(Json& root, Notes&) {
  const Json station = takeOfScene(root, "hand_station");
  if (station.is_null()) return false;
  const auto devices = groupOf(root, "devices", "/devices");
  if (!devices) return devices.error();
  const auto hand = groupOf(**devices, "hand", "/devices/hand");
  if (!hand) return hand.error();
  if ((*hand)->contains("station") && (**hand)["station"] != station)
    return bothForms("/wall/scene/hand_station", "/devices/hand/station");
  (**hand)["station"] = station;
  return true;
}

Result<bool> moveStaleAfter(Json& root, Notes&) {
  const Json after = takeOfScene(root, "stale_after_s");
  if (after.is_null()) return false;
  const auto devices = groupOf(root, "devices", "/devices");
  if (!devices) return devices.error();
  if ((*devices)->contains("stale_after_s"))
    return bothForms("/wall/scene/stale_after_s", "/devices/stale_after_s");
  (**devices)["stale_after_s"] = after;
  return true;
}

// Replaces /wall/scene/posture_hold_s and /devices/posture_hold_s by the longer of the two times,
// as /devices/posture_hold_s, because earlier versions waited for both.
Result<bool> movePostureHold(Json& root, Notes&) {
  const Json hold = takeOfScene(root, "posture_hold_s");
  if (hold.is_null()) return false;
  const auto devices = groupOf(root, "devices", "/devices");
  if (!devices) return devices.error();
  constexpr double kDefault_s = 0.15;
  const Json own = (*devices)->value("posture_hold_s", Json(kDefault_s));
  // A value that is not a number is kept, so that the loader reports it.
  if (!hold.is_number() || (own.is_number() && hold.get<double>() > own.get<double>()))
    (**devices)["posture_hold_s"] = hold;
  return true;
}

struct Step {
  MovedSetting moved;
  // Returns whether it changed `root`; adds sentences about further changes to `notes`.
  Result<bool> (*rewrite)(Json& root, Notes& notes);
};

// The steps, in the order in which the versions made these changes. The text of each names the
// place of the setting in this version; a step may write it to an intermediate place, from which a
// later step moves it.
constexpr Step kSteps[] = {
    {{"/wall/png", "an entry {\"kind\": \"png\", \"path\": ...} of /wall/outputs replaces it"},
     movePng},
    {{"/wall/scene/bindings", "/bindings replaces it"}, moveBindings},
    {{"/devices/gpio/button_command",
      "an entry {\"input\": \"panel.button\", \"action\": ...} of /bindings replaces it"},
     moveButton},
    {{"/wall/scene/hand_station", "/hands/0/station replaces it"}, moveStation},
    {{"/wall/scene/stale_after_s", "/people/stale_after_s replaces it"}, moveStaleAfter},
    {{"/wall/scene/posture_hold_s", "/postures/hold_s replaces it"}, movePostureHold},
    {{"/devices",
      "it is a list now, [{\"name\": \"ball\", \"driver\": \"spaceball\", \"port\": ..., "
      "\"spaceball\": {...}}, ...], and hands, postures, bindings, people, gpio, projectors, "
      "projector_schedule, cpu_latency_us and script stand beside it"},
     moveDevices},
};

}  // namespace

const MovedSetting* findMoved(std::string_view pointer) {
  for (const Step& step : kSteps) {
    if (step.moved.pointer == pointer) return &step.moved;
  }
  return nullptr;
}

Result<Migration> migrate(std::string_view json) {
  // parseJson() is stricter than Json::parse(): it also reports the line of an error.
  if (const auto tree = parseJson(json); !tree) return tree.error();
  Json root = Json::parse(json, nullptr, false);
  if (!root.is_object()) return Error{Errc::kMalformed, "line 1: is not a JSON object"};
  Migration migration;
  for (const Step& step : kSteps) {
    Notes notes;
    const auto changed = step.rewrite(root, notes);
    if (!changed) return changed.error();
    if (*changed)
      migration.changes.push_back(fmt::format("{}: {}", step.moved.pointer, step.moved.now));
    migration.changes.insert(migration.changes.end(), notes.begin(), notes.end());
  }
  migration.text = migration.changes.empty() ? std::string(json) : root.dump(2) + "\n";
  return migration;
}

}  // namespace merlin
