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

// Returns the configuration kept in `file` (state::lastGoodFile()), to replace `broken`; it is
// checked as any other, and has the reason why it is used. Nothing if none is kept, or if the kept
// one is not valid (any more).
std::optional<Configuration> readLastGood(const std::string& file, const Configuration& broken,
                                          const DaemonOptions& options);

// Writes on a thread of its own, so that a slow disk delays nobody. Thread-bound.
class LastGoodKeeper {
 public:
  // `configuration`: the file whose settings are kept in `file`. Only those who may read every file
  // of the configuration may read `file`, and at most its owner and group, since it contains
  // everything that is in them. `watch` must outlive this object.
  LastGoodKeeper(std::string file, const std::string& configuration, ThreadWatch& watch);
  ~LastGoodKeeper();  // writes what is not written yet
  LastGoodKeeper(const LastGoodKeeper&) = delete;
  LastGoodKeeper& operator=(const LastGoodKeeper&) = delete;

  // Keeps these settings. If the file cannot be written, the log says so, once for each reason, and
  // it is tried again every 5 s.
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
