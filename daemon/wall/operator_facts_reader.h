// OperatorFactsReader: reads the facts that the operator's tile shows, from shared memory, as other
// processes do, and from the message board.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/shm/segment.h"
#include "daemon/wall/message_board.h"
#include "render/text/operator_facts.h"

namespace merlin::wall {

// Thread-bound to the wall's thread. Never waits for a lock.
class OperatorFactsReader final : public render::text::OperatorSource {
 public:
  // `devices`: name of the devices' segment. `expects_devices`: whether devices are configured.
  // `wall` and `board` must outlive this object.
  OperatorFactsReader(const shm::WallSegment& wall, std::string devices, bool expects_devices,
                      const MessageBoard& board)
      : wall_(wall),
        devices_(std::move(devices)),
        expects_devices_(expects_devices),
        board_(board) {}

  render::text::OperatorFacts read(Timestamp now) override;

 private:
  void readStats(render::text::OperatorFacts& facts) const;
  void readContent(render::text::OperatorFacts& facts) const;
  void readFrames(double rate_hz);
  void readDevices(Timestamp now, render::text::OperatorFacts& facts);
  void readMessages(Timestamp now, render::text::OperatorFacts& facts);

  const shm::WallSegment& wall_;
  shm::SegmentFollower<shm::DevicesReader> devices_;
  const bool expects_devices_;
  const MessageBoard& board_;
  std::vector<BoardMessage> messages_;
  render::text::FrameChart chart_;
  std::uint64_t frames_read_ = 0;  // number of entries of the wall's trace read so far
};

}  // namespace merlin::wall
