// MessageBoard: stores the last events, which the operator's tile shows.
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
  // Adds a message and removes the oldest ones beyond kKept. If the text is that of the newest
  // message, only the time of this message is updated.
  void add(Timestamp at, std::string text);

  // Copies the messages to `to`, newest first. Does not wait: if another thread holds the lock, it
  // returns false and does not change `to`.
  bool tryRead(std::vector<BoardMessage>& to) const;

  static constexpr std::size_t kKept = 4;

 private:
  mutable std::mutex mutex_;
  std::deque<BoardMessage> messages_;  // guarded by mutex_; newest first
};

}  // namespace merlin::wall
