#include "daemon/status/command_queue.h"

#include <utility>

namespace merlin::status {
namespace {

// Removes the socket's address from an error, since it means nothing to a person at a browser.
Result<std::string> withoutAddress(const Result<std::string>& answer, const std::string& endpoint) {
  if (answer || !answer.error().what.starts_with(endpoint + ": ")) return answer;
  return Error{answer.error().code, answer.error().what.substr(endpoint.size() + 2)};
}

}  // namespace

bool CommandQueue::add(Waiting command) {
  if (waiting_.size() >= kMostWaiting) return false;
  waiting_.push_back(std::move(command));
  return true;
}

void CommandQueue::update(const std::string& command_endpoint, Timestamp now,
                          const Answered& answered) {
  if (sent_) {
    if (const auto answer = sender_.answer(now))
      answered(*std::exchange(sent_, std::nullopt), withoutAddress(*answer, endpoint_));
  }
  while (!waiting_.empty() && (command_endpoint.empty() || now >= waiting_.front().until)) {
    const std::uint64_t id = waiting_.front().id;
    waiting_.pop_front();
    answered(id, command_endpoint.empty()
                     ? Error{Errc::kNotFound, "this role of merlind does not run"}
                     : Error{Errc::kTimeout, "this role of merlind has not answered in time"});
  }
  if (waiting_.empty() || sent_ || !sender_.isReady()) return;
  const Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  const auto sent = sender_.send(command_endpoint, next.command, next.argument, now);
  if (!sent) return answered(next.id, sent.error());
  if (sender_.isReady()) return answered(next.id, Error{Errc::kTimeout, "nobody takes commands"});
  sent_ = next.id;
  endpoint_ = command_endpoint;
}

}  // namespace merlin::status
