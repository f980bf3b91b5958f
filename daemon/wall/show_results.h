// ShowResults: what became of the requests to show a content, each published long enough for
// whoever asked to see it.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "daemon/base/clock.h"

namespace merlin::wall {

struct ShowResult {
  std::uint32_t number = 0;  // of the request
  std::string refused{};     // why it is not shown; empty: it is
};

// Not thread-safe.
class ShowResults {
 public:
  // Long enough for clients, which poll every few milliseconds, and short enough for one who shows
  // contents in quick succession.
  static constexpr Duration kPublished = std::chrono::milliseconds(100);
  static constexpr std::size_t kMostWaiting = 40;  // if more wait, the oldest are dropped

  void add(ShowResult result) {
    if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
    waiting_.push_back(std::move(result));
  }

  // The result to be published now. They come in the order in which they were added; the last one
  // stays.
  const ShowResult& current(Timestamp now) {
    if (!waiting_.empty() && (!since_ || now - *since_ >= kPublished)) {
      current_ = std::move(waiting_.front());
      waiting_.pop_front();
      since_ = now;
    }
    return current_;
  }

 private:
  std::deque<ShowResult> waiting_;
  ShowResult current_;
  std::optional<Timestamp> since_;  // when current_ was taken
};

}  // namespace merlin::wall
