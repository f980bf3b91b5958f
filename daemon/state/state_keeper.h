// StateKeeper: the daemon's state while it runs. Changes are saved at once, on a thread of its own,
// so that a full or slow disk delays no caller.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/state/state.h"
#include "daemon/state/state_files.h"

namespace merlin::state {

// Thread-safe.
class StateKeeper {
 public:
  // Reads the state: what was written last, or the previous one if that is damaged (which is put
  // aside then), or else the defaults. A state of a newer version, or one that cannot be read, is
  // left alone: the defaults hold, and nothing is saved. `files`: null if there is no place for
  // them, which is a fault too. `watch` must outlive this object. `try_again`: time after which a
  // failed save is tried again.
  StateKeeper(std::unique_ptr<StateFiles> files, ThreadWatch& watch,
              Duration try_again = std::chrono::seconds(5));
  ~StateKeeper();  // saves what is not saved yet, unless that fails
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  State state() const;
  // `edit` changes the state; it is called at once, with the lock held. The state is saved soon
  // afterwards, once for several changes in a row. A failed save is tried again until it succeeds.
  void change(const std::function<void(State&)>& edit);

  // Why changes are not saved at present; empty: they are.
  std::string fault() const;
  // What happened since the last call, a sentence each: which file was damaged, and what is used.
  std::vector<std::string> takeNotices();
  void addNotice(std::string sentence);

  // Waits until everything is saved or a fault says why not. For tests, and before a process ends.
  void settle();

 private:
  void load();
  void loadPrevious(const Error& why);
  void loop(const std::stop_token& stop, Progress& progress);
  void save();

  std::unique_ptr<StateFiles> files_;
  const Duration try_again_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_, settled_;
  State state_;
  bool may_save_ = true;
  bool unsaved_ = false, saving_ = false;
  std::string fault_;
  std::vector<std::string> notices_;
  WatchedThread thread_;
};

}  // namespace merlin::state
