// ServerThread: the loop of one server that merlind can do without.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/base/watched_thread.h"

namespace merlin::net {

// A server for other programs is no reason to end the wall: an exception of its loop ends the
// server, not the process. Its owner sees failure(), and starts it anew. Thread-safe.
class ServerThread {
 public:
  ServerThread() = default;
  // Starts it. `round`: one round of the loop; it takes at most half a second. `threads` outlives
  // this.
  ServerThread(ThreadWatch& threads, std::string name, std::function<void()> round);

  // Why the loop has ended; empty while it runs.
  std::string failure() const;
  // Asks it to stop and waits until it has.
  void stop() { thread_.stop(); }

 private:
  struct State {
    mutable std::mutex mutex;
    std::string failure;  // guarded by mutex
  };
  std::shared_ptr<State> state_;  // shared: the thread writes it, wherever this is moved to
  WatchedThread thread_;
};

}  // namespace merlin::net
