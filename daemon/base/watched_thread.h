// WatchedThread: a thread that works until it is asked to stop, and is registered with a
// ThreadWatch.
//
// A thread that serves others must only end when it is asked to stop. If one ends otherwise (an
// uncaught exception, an early return), the watch knows its name and the reason; merlind reports it
// and exits, so that systemd restarts it. Each thread counts its own progress, so that the watchdog
// notices a single thread that hangs.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace merlin {

// Counts the rounds of one thread's loop. Thread-safe.
class Progress {
 public:
  void step() noexcept { count_.fetch_add(1, std::memory_order_relaxed); }
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }

  // Scope of a call that may take long and cannot be interrupted (a host name look-up): the thread
  // does not count as hung meanwhile.
  class Pause {
   public:
    explicit Pause(Progress& progress) noexcept : progress_(progress) { progress_.paused_ = true; }
    ~Pause() {
      progress_.step();
      progress_.paused_ = false;
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Progress& progress_;
  };
  bool paused() const noexcept { return paused_; }

 private:
  std::atomic<std::uint64_t> count_{0};
  std::atomic<bool> paused_{false};
};

// Gives the calling thread, and threads that it starts, a low priority (nice 10), so that drawing
// frames comes first. Not the lowest: on a machine that other programs keep busy, a thread with
// nice 19 gets a hundredth of a processor, and a reload takes minutes.
void giveWay() noexcept;

// Names the calling thread for `top -H` and debuggers, which show the first 15 characters.
void nameThread(const std::string& name) noexcept;

// State of one thread, copied by ThreadWatch::threads().
struct ThreadState {
  std::uint64_t id = 0;  // unique within the watch
  std::string name;      // for a person: "status of the wall"
  std::uint64_t progress = 0;
  bool paused = false;  // in a call that may take long
  bool ended = false;   // ended without having been asked to
  std::string reason;   // why it ended
};

// The threads of one process. Thread-safe. Must outlive its threads.
class ThreadWatch {
 public:
  // Returns the threads that run, or that ended without having been asked to stop, in the order of
  // their start.
  std::vector<ThreadState> threads() const;

 private:
  friend class WatchedThread;
  struct Entry {
    std::uint64_t id = 0;
    std::string name;
    Progress progress;
    bool ended = false;
    std::string reason;
  };
  std::shared_ptr<Entry> add(std::string name);
  void remove(const std::shared_ptr<Entry>& entry);
  void ended(const std::shared_ptr<Entry>& entry, std::string reason);

  mutable std::mutex mutex_;
  std::uint64_t next_id_ = 1;
  // Shared between the watch and the thread: either may be the last to use an entry.
  std::vector<std::shared_ptr<Entry>> entries_;
};

// Thread-bound to its owner.
class WatchedThread {
 public:
  // The body of the thread. It must step `progress` at least once a second and return after a stop.
  using Body = std::function<void(const std::stop_token& stop, Progress& progress)>;

  WatchedThread() = default;
  // Starts the thread. `watch` must outlive it.
  WatchedThread(ThreadWatch& watch, std::string name, Body body);
  WatchedThread(WatchedThread&&) noexcept = default;
  WatchedThread& operator=(WatchedThread&& other) noexcept;
  WatchedThread(const WatchedThread&) = delete;
  WatchedThread& operator=(const WatchedThread&) = delete;
  ~WatchedThread() { stop(); }

  void requestStop() noexcept { thread_.request_stop(); }
  // Asks the thread to stop and waits for its end; does nothing if none runs.
  void stop();

 private:
  ThreadWatch* watch_ = nullptr;
  std::shared_ptr<ThreadWatch::Entry> entry_;  // shared: see ThreadWatch
  std::jthread thread_;
};

}  // namespace merlin
