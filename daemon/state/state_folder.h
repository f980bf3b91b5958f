// StateFolder: keeps the state in a file, with the previous and a damaged one beside it; and
// functions that determine where that file is.
#pragma once

#include <string>
#include <vector>

#include "daemon/state/state_files.h"

namespace merlin::state {

// FILE, FILE.previous, FILE.damaged; while it is being written also FILE.next and FILE.keep.
class StateFolder final : public StateFiles {
 public:
  explicit StateFolder(std::string path) : path_(std::move(path)) {}

  Result<std::string> read() override;
  Result<std::string> readPrevious() override;
  // Makes the folder if it is missing.
  Result<Ok> write(const std::string& text) override;
  Result<Ok> putAside() override;
  const std::string& name() const override { return path_; }

 private:
  std::string path_;
};

// The folder for everything that has to outlive merlind: the folder that systemd sets
// (StateDirectory=), else /var/lib/merlin for root, else $XDG_STATE_HOME/merlin or
// ~/.local/state/merlin. Empty if there is no such folder, since this user has no home. Reads the
// environment: to be called before any thread starts.
std::string stateFolder();

// The file that is used: `wanted`, or, if that is empty, INSTANCE.state.json in stateFolder(). A
// process without a wall has a file of its own, with ".devices" appended, since the process of the
// wall may have the other. Empty if there is no folder. To be called before any thread starts.
std::string stateFile(const std::string& wanted, const std::string& instance, bool has_wall);

// The state file as found by a program other than merlind, which knows neither merlind's user nor
// its environment: stateFile() of a process with a wall, or, if there is no such file, that of the
// installed service in /var/lib/merlin if that exists.
std::string findStateFile(const std::string& wanted, const std::string& instance);

// The file in which a process of this role keeps the last good settings of this configuration: in
// stateFolder(), or empty if there is none. Reads the environment: to be called before any thread
// starts.
std::string lastGoodFile(const std::string& configuration, const std::string& role);

// The existing files of that kind, as found by a program other than merlind: in stateFolder(), or,
// if there are none, in the installed services' /var/lib/merlin.
std::vector<std::string> findLastGoodFiles(const std::string& configuration);

// The content folder that is used, as an absolute path, so that other programs can use it:
// `wanted`, or, if that is empty, INSTANCE.shown beside the state's `file`, from stateFile(). Empty
// if there is neither.
std::string shownFolder(const std::string& wanted, const std::string& file,
                        const std::string& instance);

}  // namespace merlin::state
