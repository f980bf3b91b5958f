// ServerThread: a thread for the loop of a server that merlind does not depend on.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/base/watched_thread.h"

namespace merlin::net {

// An exception in the loop ends the server, not the process, so that a server for other programs
// cannot stop the wall. Its owner checks failure() and starts it again. Thread-safe.
class ServerThread {
 public:
  ServerThread() = default;
  // Starts the thread. `round`: one round of the loop, which must take at most half a second.
  // `threads` must outlive this.
  ServerThread(ThreadWatch& threads, std::string name, std::function<void()> round);

  // Why the loop has ended; empty while it runs.
  std::string failure() const;
  // Asks the thread to stop and waits for its end.
  void stop() { thread_.stop(); }

 private:
  struct State {
    mutable std::mutex mutex;
    std::string failure;  // guarded by mutex
  };
  std::shared_ptr<State> state_;  // shared with the thread, so that this can be moved
  WatchedThread thread_;
};

}  // namespace merlin::net
