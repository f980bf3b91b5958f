// ShowResults: a queue of the results of requests to show a content. Each result is published long
// enough for the client to read it.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "daemon/base/clock.h"

namespace merlin::wall {

struct ShowResult {
  std::uint32_t number = 0;  // number of the request
  std::string refused{};     // why the content is not shown; empty: it is shown
};

// Not thread-safe.
class ShowResults {
 public:
  // Time for which each result is published at least. It is long enough for clients, which poll
  // every few milliseconds, and short enough for a client that shows contents in quick succession.
  static constexpr Duration kPublished = std::chrono::milliseconds(100);
  static constexpr std::size_t kMostWaiting = 40;  // beyond this, the oldest results are dropped

  void add(ShowResult result) {
    if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
    waiting_.push_back(std::move(result));
  }

  // Returns the result to be published now. The results are published in the order in which they
  // were added; the last one stays.
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
  std::optional<Timestamp> since_;  // since when current_ is published
};

}  // namespace merlin::wall
