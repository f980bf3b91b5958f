#include "daemon/net/server_keeper.h"

#include <utility>

#include <fmt/format.h>

namespace merlin::net {
namespace {

constexpr Duration kRetry = std::chrono::seconds(5);
constexpr Duration kTellAgain = std::chrono::seconds(5);

}  // namespace

std::string sentAwaySentence(const ServerReport& report, std::uint64_t& told) {
  const std::uint64_t now = report.sentAway();
  const std::uint64_t fresh = now - std::exchange(told, now);
  if (fresh == 0) return {};
  return fmt::format("{}: {} connection{} refused or closed; the last: {}", report.name, fresh,
                     fresh == 1 ? " was" : "s were", report.last);
}

ServerKeeper::ServerKeeper(std::string name, Start start)
    : name_(std::move(name)), start_(std::move(start)), failure_("not started yet") {}

void ServerKeeper::tend(Timestamp now) {
  std::unique_ptr<Server> ended;  // destroyed without the lock: it waits for its thread
  {
    const std::lock_guard lock(mutex_);
    if (server_ && !server_->failure().empty()) {
      failure_ = server_->failure();
      next_try_ = now + kRetry;
      told_sent_away_ = 0;
      ended = std::move(server_);
    }
    if (server_ || now < next_try_) return;
    next_try_ = now + kRetry;
  }
  auto started = start_();
  const std::lock_guard lock(mutex_);
  failure_ = started ? "" : started.error().what;
  if (started) server_ = *std::move(started);
}

ServerHealth ServerKeeper::health() const {
  const std::lock_guard lock(mutex_);
  ServerHealth health{name_, failure_, {}};
  if (server_) health.report = server_->report();
  health.report.name = name_;
  return health;
}

std::vector<Event> ServerKeeper::takeEvents(Timestamp now) {
  std::vector<Event> events;
  const std::lock_guard lock(mutex_);
  if (!server_ && next_try_ == Timestamp{}) return events;  // not tried yet
  if (!told_ || failure_ != told_failure_) {
    if (!failure_.empty())
      events.push_back(faultEvent(fmt::format("{}: failed ({}); retried every {:.0f} s", name_,
                                              failure_, toSeconds(kRetry))));
    else
      events.push_back(told_ ? newsEvent(name_ + ": running") : routineEvent(name_ + ": running"));
    told_ = true;
    told_failure_ = failure_;
  }
  if (server_ && now - told_at_ >= kTellAgain) {
    if (auto sentence = sentAwaySentence(server_->report(), told_sent_away_); !sentence.empty()) {
      told_at_ = now;
      events.push_back(faultEvent(std::move(sentence)));
    }
  }
  return events;
}

}  // namespace merlin::net
