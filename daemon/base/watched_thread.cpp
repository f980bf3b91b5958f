#include "daemon/base/watched_thread.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace merlin {

void giveWay() noexcept { ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 10); }

void nameThread(const std::string& name) noexcept { ::prctl(PR_SET_NAME, name.c_str()); }

std::vector<ThreadState> ThreadWatch::threads() const {
  const std::lock_guard lock(mutex_);
  std::vector<ThreadState> states;
  states.reserve(entries_.size());
  for (const auto& e : entries_)
    states.push_back(
        {e->id, e->name, e->progress.count(), e->progress.paused(), e->ended, e->reason});
  return states;
}

std::shared_ptr<ThreadWatch::Entry> ThreadWatch::add(std::string name) {
  auto entry = std::make_shared<Entry>();
  entry->name = std::move(name);
  const std::lock_guard lock(mutex_);
  entry->id = next_id_++;
  entries_.push_back(entry);
  return entry;
}

void ThreadWatch::remove(const std::shared_ptr<Entry>& entry) {
  const std::lock_guard lock(mutex_);
  std::erase(entries_, entry);
}

void ThreadWatch::ended(const std::shared_ptr<Entry>& entry, std::string reason) {
  const std::lock_guard lock(mutex_);
  entry->ended = true;
  entry->reason = std::move(reason);
}

WatchedThread::WatchedThread(ThreadWatch& watch, std::string name, Body body)
    : watch_(&watch), entry_(watch.add(std::move(name))) {
  thread_ =
      std::jthread([&watch, entry = entry_, body = std::move(body)](const std::stop_token& stop) {
        nameThread(entry->name);
        std::string reason = "returned without having been asked to stop";
        try {
          body(stop, entry->progress);
        } catch (const std::exception& e) {
          reason = e.what();
        }
        if (!stop.stop_requested()) watch.ended(entry, reason);
      });
}

WatchedThread& WatchedThread::operator=(WatchedThread&& other) noexcept {
  if (this == &other) return *this;
  stop();
  watch_ = std::exchange(other.watch_, nullptr);
  entry_ = std::exchange(other.entry_, nullptr);
  thread_ = std::move(other.thread_);
  return *this;
}

void WatchedThread::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  if (entry_) watch_->remove(entry_);
  entry_.reset();
}

}  // namespace merlin
