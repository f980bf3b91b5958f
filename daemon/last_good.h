// LastGood: the settings with which merlind last ran, kept on disk, so that it can start with them
// when somebody has broken the configuration meanwhile.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "config/settings.h"
#include "daemon/base/watched_thread.h"
#include "daemon/configuration.h"

namespace merlin {

// Reads the last good settings from `file` (state::lastGoodFile()), which are to be used instead of
// the invalid configuration `broken`. They are checked like any configuration; `instead_of` says
// why they are used. Returns nothing if `file` is empty or missing, or its settings are invalid.
std::optional<Configuration> readLastGood(const std::string& file, const Configuration& broken,
                                          const DaemonOptions& options);

// Writes the file on a thread of its own, so that a slow disk does not delay the caller.
// Thread-bound.
class LastGoodKeeper {
 public:
  // `configuration`: the configuration file whose settings are kept in `file`. Since `file`
  // contains all of these settings, its group can read it only if the permissions of every file of
  // the configuration allow that, and others never can. `watch` must outlive this object.
  LastGoodKeeper(std::string file, const std::string& configuration, ThreadWatch& watch);
  ~LastGoodKeeper();  // writes the settings that are not written yet
  LastGoodKeeper(const LastGoodKeeper&) = delete;
  LastGoodKeeper& operator=(const LastGoodKeeper&) = delete;

  // Queues these settings for writing. If writing fails, it is tried again every 5 s, and each new
  // reason is logged once.
  void keep(const Settings& settings);

 private:
  void loop(const std::stop_token& stop, Progress& progress);
  bool write(const std::string& text);

  const std::string file_, configuration_;
  std::mutex mutex_;  // guards waiting_
  std::condition_variable_any wake_;
  std::optional<std::string> waiting_;
  std::string logged_;    // the reason that was logged last
  WatchedThread thread_;  // declared last: it uses all others
};

}  // namespace merlin
