// StateFolder: stores the state in a file, with the previous one and a damaged one beside it. Also
// functions that determine the paths of this file and of others that outlive merlind.
#pragma once

#include <string>
#include <vector>

#include "daemon/state/state_files.h"

namespace merlin::state {

// Stores the last state in FILE, the one before it in FILE.previous, and an unusable one, which
// putAside() has moved, in FILE.damaged. FILE.next and FILE.keep exist only while the state is
// being written.
class StateFolder final : public StateFiles {
 public:
  explicit StateFolder(std::string path) : path_(std::move(path)) {}

  Result<std::string> read() override;
  Result<std::string> readPrevious() override;
  // Creates the folder of the file if it is missing.
  Result<Ok> write(const std::string& text) override;
  Result<Ok> putAside() override;
  const std::string& name() const override { return path_; }

 private:
  std::string path_;
};

// Returns the folder for everything that has to outlive merlind: $STATE_DIRECTORY, which systemd
// sets (StateDirectory=); else /var/lib/merlin for root; else $XDG_STATE_HOME/merlin; else
// $HOME/.local/state/merlin. Empty if none of these variables is set. Reads the environment: to be
// called before any thread starts.
std::string stateFolder();

// Returns the path of the state file: `wanted`, or, if that is empty, INSTANCE.state.json in
// stateFolder(); empty if there is no folder. For a process without a wall, ".devices" is appended,
// since the process with the wall may use the other file. To be called before any thread starts.
std::string stateFile(const std::string& wanted, const std::string& instance, bool has_wall);

// Returns the path of the state file for a program other than merlind, which knows neither
// merlind's user nor its environment: stateFile() of a process with a wall; or, if `wanted` is
// empty and this file does not exist, the file of the installed service in /var/lib/merlin if that
// exists. To be called before any thread starts.
std::string findStateFile(const std::string& wanted, const std::string& instance);

// Returns the path of the file in which a process of this role stores the settings of this
// configuration with which it ran last: a file in stateFolder(); empty if there is no folder.
// `role`: "wall", "devices" or "all". Reads the environment: to be called before any thread starts.
std::string lastGoodFile(const std::string& configuration, const std::string& role);

// Returns the files of lastGoodFile() that exist, one for each role, for a program other than
// merlind: those in stateFolder(), or, if there are none, those of the installed services in
// /var/lib/merlin.
std::vector<std::string> findLastGoodFiles(const std::string& configuration);

// Returns the absolute path of the content folder: `wanted`, or, if that is empty, INSTANCE.shown
// beside the state file `file` (from stateFile()). Empty if both are empty.
std::string shownFolder(const std::string& wanted, const std::string& file,
                        const std::string& instance);

}  // namespace merlin::state
