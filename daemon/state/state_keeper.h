// StateKeeper: holds the daemon's state while it runs. Changes are saved at once, on the keeper's
// own thread, so that a full or slow disk delays no caller.
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
  // Reads the state that was written last. If it is damaged, it is moved aside, and the previous
  // state is used; the previous state is also used if the last one is missing. If there is no
  // usable state, the defaults of State are used. A state of a newer version, or one that cannot be
  // read, is not touched: the defaults are used and changes are not saved; fault() then has the
  // reason. `files`: null if there is no place for them, which is a fault too. `watch` must outlive
  // this object. `try_again`: time after which a failed save is tried again.
  StateKeeper(std::unique_ptr<StateFiles> files, ThreadWatch& watch,
              Duration try_again = std::chrono::seconds(5));
  ~StateKeeper();  // saves changes that are not saved yet; tries this only once
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  State state() const;
  // Changes the state by `edit`, which is called before this returns, with the keeper's lock held,
  // and must not call the keeper. The state is saved soon afterwards; several changes in a row may
  // be saved together. A failed save is tried again until it succeeds.
  void change(const std::function<void(State&)>& edit);

  // Returns the reason why changes are not saved at present; empty: they are saved.
  std::string fault() const;
  // Returns the notices since the last call, each a sentence: those of addNotice(), and which state
  // file was damaged or missing and what is used instead.
  std::vector<std::string> takeNotices();
  void addNotice(std::string sentence);

  // Waits until every change is saved, or until fault() tells why this is not possible. For tests,
  // and before a process ends.
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
