#include "daemon/wall/message_board.h"

#include <utility>

namespace merlin::wall {

void MessageBoard::add(Timestamp at, std::string text) {
  const std::lock_guard lock(mutex_);
  if (!messages_.empty() && messages_.front().text == text) messages_.pop_front();
  messages_.push_front({at, std::move(text)});
  if (messages_.size() > kKept) messages_.pop_back();
}

bool MessageBoard::tryRead(std::vector<BoardMessage>& to) const {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return false;
  to.assign(messages_.begin(), messages_.end());
  return true;
}

}  // namespace merlin::wall
