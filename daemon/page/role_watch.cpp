#include "daemon/page/role_watch.h"

#include <utility>

#include <fmt/format.h>

#include "daemon/json/json_tree.h"

namespace merlin::page {
namespace {

bool isObject(const std::string& document) {
  const auto parsed = parseJson(document);
  return parsed && parsed->kind == JsonNode::Kind::kObject;
}

}  // namespace

template <typename Reader>
RoleWatch<Reader>::RoleWatch(const std::string& instance, std::string role, EventLog& events)
    : events_(events),
      follower_(instance, std::move(role), {"status", "metrics", "event"},
                SharedMemory::From::kOwnGroup) {}

template <typename Reader>
void RoleWatch<Reader>::update(Timestamp now) {
  const bool ran = isRunning();
  const bool another = follower_.update(now);
  if (another) {
    status_.clear();
    metrics_.clear();
    heard_ = {};
  }
  while (const auto message = follower_.take()) take(*message, now);
  if (!another && std::exchange(told_, true)) return;
  const char* const what = !isRunning() ? "does not run" : ran ? "was started again" : "runs";
  events_.add("page", "role", fmt::format("the role {} {}", role(), what));
  told_ = true;
}

template <typename Reader>
void RoleWatch<Reader>::take(const status::TopicFollower::Message& message, Timestamp now) {
  if (message.topic == "event") return events_.addDocument(role(), message.document);
  if (!isObject(message.document)) return;
  if (message.topic == "metrics") metrics_ = message.document;
  if (message.topic != "status") return;
  status_ = message.document;
  heard_ = now;
}

template class RoleWatch<shm::SegmentReader<shm::WallSegment>>;
template class RoleWatch<shm::DevicesReader>;

}  // namespace merlin::page
