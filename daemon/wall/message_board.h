// MessageBoard: the last events, for the operator's tile.
#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"

namespace merlin::wall {

struct BoardMessage {
  Timestamp at;
  std::string text;
};

// Thread-safe.
class MessageBoard {
 public:
  // Adds a message; the oldest of more than kKept are dropped. A repeated last message is renewed.
  void add(Timestamp at, std::string text);

  // Copies the messages to `to`, the newest first. Does not wait: returns false, and leaves `to` as
  // it is, while another thread adds one.
  bool tryRead(std::vector<BoardMessage>& to) const;

  static constexpr std::size_t kKept = 4;

 private:
  mutable std::mutex mutex_;
  std::deque<BoardMessage> messages_;  // guarded by mutex_; the newest first
};

}  // namespace merlin::wall
