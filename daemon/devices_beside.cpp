#include "daemon/devices_beside.h"

#include <optional>

#include "daemon/status/projectors.h"

namespace merlin {
namespace {

constexpr Duration kPatience = std::chrono::seconds(5);

std::vector<wall::ProjectorsSeen> seenIn(const std::string& document) {
  std::vector<wall::ProjectorsSeen> all;
  for (const status::ProjectorStatus& p : status::projectorsIn(document)) {
    all.push_back(wall::projectorSeen(
        p.power, p.wanted.empty() ? std::nullopt : std::optional(p.wanted == "on")));
  }
  return all;
}

}  // namespace

DevicesBeside::DevicesBeside(const std::string& instance)
    : devices_(instance, "devices", {"status"}) {}

Result<Ok> DevicesBeside::send(const std::string& command, Timestamp now) {
  const std::lock_guard lock(mutex_);
  if (commands_.add({0, command, "", now + kPatience})) return Ok{};
  return Error{Errc::kBusy, "too many commands wait for the role devices; try again later"};
}

void DevicesBeside::update(Timestamp now,
                           const std::function<void(const std::string& why)>& refused) {
  if (devices_.update(now)) projectors_.clear();
  while (const auto message = devices_.take()) projectors_ = seenIn(message->document);
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
