#include "daemon/page/role_watch.h"

#include <utility>

#include "daemon/base/fixed_text.h"
#include "daemon/base/log.h"
#include "daemon/json/json_tree.h"

namespace merlin::page {
namespace {

const shm::Header& headerOf(const shm::WallSegment& segment) { return segment.header; }
const shm::Header& headerOf(const shm::DeviceSlots& slots) { return *slots.header; }

bool isObject(const std::string& document) {
  const auto parsed = parseJson(document);
  return parsed && parsed->kind == JsonNode::Kind::kObject;
}

}  // namespace

template <typename Reader>
RoleWatch<Reader>::RoleWatch(const std::string& instance, std::string role, EventLog& events)
    : role_(std::move(role)),
      events_(events),
      follower_(shm::segmentName(instance, role_.c_str()), SharedMemory::From::kOwnGroup),
      topics_({"status", "metrics", "event"}) {}

template <typename Reader>
void RoleWatch<Reader>::update(Timestamp now) {
  segment_ = follower_.get(now);
  follow(segment_ ? &headerOf(*segment_) : nullptr);
  while (const auto message = topics_.take()) take(*message, now);
  if (!told_ || was_running_ != isRunning()) {
    events_.add(
        "page", "role",
        isRunning() ? "the role " + role_ + " runs" : "the role " + role_ + " does not run");
    told_ = true;
    was_running_ = isRunning();
  }
}

// Connects to a new run of the role, and forgets what an earlier one published.
template <typename Reader>
void RoleWatch<Reader>::follow(const shm::Header* header) {
  const std::uint64_t generation = header ? header->generation : 0;
  if (generation == generation_) return;
  generation_ = generation;
  status_.clear();
  metrics_.clear();
  heard_ = {};
  command_endpoint_ = header ? textIn(header->command_endpoint) : "";
  // A new socket for each run: the old one would connect again, but not after every fault.
  (void)topics_.connect("").ok();
  const auto connected =
      topics_.connect(std::string(header ? textIn(header->status_endpoint) : ""));
  if (!connected) logWarning("the role {} cannot be followed: {}", role_, connected.error().what);
}

template <typename Reader>
void RoleWatch<Reader>::take(const status::TopicFollower::Message& message, Timestamp now) {
  if (message.topic == "event") return events_.addDocument(role_, message.document);
  if (!isObject(message.document)) return;
  if (message.topic == "metrics") metrics_ = message.document;
  if (message.topic != "status") return;
  status_ = message.document;
  heard_ = now;
}

template class RoleWatch<shm::SegmentReader<shm::WallSegment>>;
template class RoleWatch<shm::DevicesReader>;

}  // namespace merlin::page
