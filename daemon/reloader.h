// Reloader: lets merlind read its configuration again, on SIGHUP or the command reload.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/effective.h"
#include "config/loader.h"
#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/configuration.h"
#include "daemon/devices/devices_role.h"
#include "daemon/named_files.h"
#include "daemon/reload/answer.h"
#include "daemon/state/state_keeper.h"
#include "daemon/status/services.h"
#include "daemon/wall/wall_role.h"

namespace merlin {

// Reads and checks the file on a thread that exists only during a request and has the lowest
// priority. Then tend(), on the main thread, applies the changes or, if a change takes effect only
// at a start, returns kRestart. Either all changes are applied or none. Requests are executed one
// after another.
class Reloader {
 public:
  // What tend() did. kSwapped: the settings of a valid file were put into effect. kRestart: the
  // file is valid and needs a restart; the requester was told so, and the caller must restart the
  // process now.
  enum class Done { kNothing, kSwapped, kRestart };

  struct Parts {
    devices::DevicesRole* devices;  // null: this process lacks the part
    wall::WallRole* wall;
    status::Services& services;  // reports why a reload was refused, until one succeeds
    ThreadWatch& watch;
    const Clock& clock;
    std::function<void()> wake;  // makes the main thread call tend() soon; called on any thread
    const state::StateKeeper* keeper = nullptr;  // of the wall's alignment; null: there is none
  };
  // The settings of the file, and the state of the files that they name before any part of the
  // process read them. So a file that changed while the process started counts as changed,
  // whichever version a part has read.
  struct Configured {
    Settings settings;
    NamedFiles named;
  };
  // `configured`: the settings of `file` that are in effect. `running`: these settings with the
  // changes made at the start (the emulators' ports); only tend() changes them. `running` and the
  // parts must outlive this object.
  Reloader(std::string file, const DaemonOptions& options, Configured configured, Settings& running,
           const Parts& parts);

  // Executes the command reload. "now" and "check" (which only reports what would be done) return
  // {"request": N}. The argument N returns {"pending": true} until that request was executed, then
  // its answer (reload::answerText()). The last 32 answers are kept. While a restart is due, a
  // further request is not queued and N is the number of the request that causes the restart.
  // Errors: kInvalidArgument; kBusy (8 requests wait). Returns at once. Thread-safe.
  Result<std::string> run(const std::string& argument);
  // Requests a reload like run("now"), but its result is reported only in the log and by events.
  // Does nothing if 8 requests wait already. Thread-safe.
  void request();

  // Starts the thread for the next request, and applies the settings that a thread has read. To be
  // called by the main thread, from the first frame on. Takes up to 50 ms for each device that is
  // recreated.
  Done tend();
  // Returns the settings of the file that are in effect. To be called by the thread of tend().
  const Settings& configured() const noexcept { return configured_.settings; }

 private:
  struct Request {
    std::uint32_t number = 0;
    bool only_check = false;
    bool is_command = true;  // the requester waits for the answer
  };
  struct ReadFile {
    reload::Answer answer;
    Settings settings;
    NamedFiles named;  // the files that `settings` names
    devices::Trained trained;
  };
  ReadFile readGuarded() const;
  ReadFile read() const;
  void checkStart(LoadedSettings& loaded, const std::vector<SettingChange>& changes) const;
  reload::Outcome judge(LoadedSettings& loaded, const NamedFiles& named, reload::Plan& plan) const;
  reload::Readers process() const;
  void fitAlignments(ReadFile& file) const;
  Result<std::string> add(bool only_check, bool is_command);
  void read(const std::stop_token& stop, Progress& progress);
  Done finish(const Request& request, ReadFile file);
  void swap(const ReadFile& file);
  void report(const reload::Answer& answer);

  const std::string file_;
  const DaemonOptions options_;
  Configured configured_;  // changed by tend() while nothing is read
  Settings& running_;
  Parts parts_;
  std::mutex mutex_;  // guards all below but thread_
  std::condition_variable_any ending_;
  std::uint32_t last_number_ = 0;
  std::deque<Request> waiting_;
  std::optional<Request> current_;
  std::optional<ReadFile> read_;  // of current_
  std::deque<std::pair<std::uint32_t, std::string>> answers_;
  // Once the process is to start again: the time of the restart, and the request whose answer
  // announces it.
  std::optional<Timestamp> restart_at_;
  std::uint32_t restart_number_ = 0;
  WatchedThread thread_;  // runs read() for current_
};

}  // namespace merlin
