#include "config/migrate.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/json_tree.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;

// The newest frame as a file was a group of its own before there was a list of outputs.
Result<bool> movePng(Json& root) {
  const auto wall = root.find("wall");
  if (wall == root.end() || !wall->is_object() || !wall->contains("png")) return false;
  if (wall->contains("outputs")) {
    return Error{Errc::kInvalidArgument,
                 "/wall has both png and outputs: move the path into /wall/outputs by hand"};
  }
  const Json png = (*wall)["png"];
  wall->erase("png");
  const bool writes =
      png.is_object() && !png.value("path", Json("")).empty() && png.value("path", Json("")) != "";
  if (!writes) return true;
  Json output = {{"kind", "png"}};
  output.update(png);
  (*wall)["outputs"] = Json::array({Json{{"kind", "shared_memory"}}, std::move(output)});
  return true;
}

struct Step {
  MovedSetting moved;
  Result<bool> (*rewrite)(Json& root);  // whether it changed anything
};

// In the order in which versions made them.
constexpr Step kSteps[] = {
    {{"/wall/png",
      "an entry {\"kind\": \"png\", \"path\": ...} of /wall/outputs stands in its place"},
     movePng},
};

}  // namespace

const MovedSetting* findMoved(std::string_view pointer) {
  for (const Step& step : kSteps) {
    if (step.moved.pointer == pointer) return &step.moved;
  }
  return nullptr;
}

Result<Migration> migrate(std::string_view json) {
  if (const auto tree = parseJson(json); !tree) return tree.error();  // stricter than what follows
  Json root = Json::parse(json, nullptr, false);
  if (!root.is_object()) return Error{Errc::kMalformed, "line 1: is not a JSON object"};
  Migration migration;
  for (const Step& step : kSteps) {
    const auto changed = step.rewrite(root);
    if (!changed) return changed.error();
    if (*changed)
      migration.changes.push_back(fmt::format("{}: {}", step.moved.pointer, step.moved.now));
  }
  migration.text = migration.changes.empty() ? std::string(json) : root.dump(2) + "\n";
  return migration;
}

}  // namespace merlin
