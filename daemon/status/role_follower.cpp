#include "daemon/status/role_follower.h"

#include <utility>

#include "daemon/base/fixed_text.h"
#include "daemon/base/log.h"

namespace merlin::status {
namespace {

constexpr Duration kConnectAgain = std::chrono::seconds(1);

const shm::Header& headerOf(const shm::WallSegment& segment) { return segment.header; }
const shm::Header& headerOf(const shm::DeviceSlots& slots) { return *slots.header; }

}  // namespace

template <typename Reader>
RoleFollower<Reader>::RoleFollower(const std::string& instance, std::string role,
                                   std::vector<std::string> topics, SharedMemory::From from)
    : role_(std::move(role)),
      follower_(shm::segmentName(instance, role_.c_str()), from),
      topics_(std::move(topics)) {}

template <typename Reader>
bool RoleFollower<Reader>::update(Timestamp now) {
  segment_ = follower_.get(now);
  const shm::Header* const header = segment_ ? &headerOf(*segment_) : nullptr;
  const std::uint64_t generation = header ? header->generation : 0;
  const bool another = generation != generation_;
  if (!another && now - connected_ < kConnectAgain) return false;
  if (another) {
    generation_ = generation;
    command_endpoint_ = header ? textIn(header->command_endpoint) : "";
    // Uses a new socket for each run, because the old one would not reconnect after every kind of
    // fault.
    (void)topics_.connect("").ok();
  }
  connected_ = now;
  connect(std::string(header ? textIn(header->status_endpoint) : ""));
  return another;
}

// Connects to the topics at `endpoint`; does nothing if connected to it already. Called again after
// a failure, such as too many open files, because the run may last for months.
template <typename Reader>
void RoleFollower<Reader>::connect(const std::string& endpoint) {
  const auto connected = topics_.connect(endpoint);
  const std::string fault = connected ? std::string() : connected.error().what;
  if (!fault.empty() && fault != fault_)
    logWarning("cannot receive the status of the role {}: {}", role_, fault);
  fault_ = fault;
}

template class RoleFollower<shm::SegmentReader<shm::WallSegment>>;
template class RoleFollower<shm::DevicesReader>;

}  // namespace merlin::status
