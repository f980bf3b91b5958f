#include "daemon/devices_beside.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "daemon/json/json_tree.h"

namespace merlin {
namespace {

constexpr Duration kPatience = std::chrono::seconds(5);

const JsonNode* member(const JsonNode& node, std::string_view key) {
  const auto found = std::ranges::find(node.members, key, &JsonNode::Member::key);
  return found == node.members.end() ? nullptr : &found->value;
}

std::string textOf(const JsonNode& node, std::string_view key) {
  const JsonNode* const found = member(node, key);
  return found ? found->text : std::string();
}

// What status::addProjectors() wrote.
std::vector<wall::ProjectorsSeen> projectorsIn(const std::string& document) {
  const auto parsed = parseJson(document);
  const JsonNode* const list = parsed ? member(*parsed, "projectors") : nullptr;
  std::vector<wall::ProjectorsSeen> all;
  if (!list) return all;
  for (const JsonNode::Member& projector : list->members) {
    const std::string wanted = textOf(projector.value, "wanted");
    all.push_back(
        wall::projectorSeen(textOf(projector.value, "power"),
                            wanted.empty() ? std::nullopt : std::optional(wanted == "on")));
  }
  return all;
}

}  // namespace

DevicesBeside::DevicesBeside(const std::string& instance)
    : devices_(instance, "devices", {"status"}) {}

Result<Ok> DevicesBeside::send(const std::string& command, Timestamp now) {
  const std::lock_guard lock(mutex_);
  if (commands_.add({0, command, "", now + kPatience})) return Ok{};
  return Error{Errc::kBusy, "too many commands wait for the role devices"};
}

void DevicesBeside::update(Timestamp now,
                           const std::function<void(const std::string& why)>& refused) {
  if (devices_.update(now)) projectors_.clear();
  while (const auto message = devices_.take()) projectors_ = projectorsIn(message->document);
  std::vector<std::string> reasons;
  {
    const std::lock_guard lock(mutex_);
    commands_.update(devices_.commandEndpoint(), now,
                     [&](std::uint64_t, const Result<std::string>& answer) {
                       if (!answer) reasons.push_back(answer.error().what);
                     });
  }
  for (const std::string& why : reasons) refused(why);
}

}  // namespace merlin
