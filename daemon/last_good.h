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

// The configuration that `file` (state::lastGoodFile()) keeps instead of that in `broken`, checked
// as any other, with the reason why it is used; nothing if none is kept, or if what is kept is not
// valid (any more).
std::optional<Configuration> readLastGood(const std::string& file, const Configuration& broken,
                                          const DaemonOptions& options);

// Writes on a thread of its own: a disk may take its time, and holds nobody up. Thread-bound.
class LastGoodKeeper {
 public:
  // `configuration`: the file whose settings are kept in `file`, which at most those may read who
  // may read each file of the configuration, and never others than its owner and its group: it has
  // all that stands in them. `watch` outlives this.
  LastGoodKeeper(std::string file, const std::string& configuration, ThreadWatch& watch);
  ~LastGoodKeeper();  // writes what is not written yet
  LastGoodKeeper(const LastGoodKeeper&) = delete;
  LastGoodKeeper& operator=(const LastGoodKeeper&) = delete;

  // A file that cannot be written is said in the log, once for each reason.
  void keep(const Settings& settings);

 private:
  void loop(const std::stop_token& stop, Progress& progress);
  void write(const std::string& text);

  const std::string file_, configuration_;
  std::mutex mutex_;  // guards waiting_
  std::condition_variable_any wake_;
  std::optional<std::string> waiting_;
  std::string logged_;    // the reason that was logged last
  WatchedThread thread_;  // declared last: it uses all others
};

}  // namespace merlin
