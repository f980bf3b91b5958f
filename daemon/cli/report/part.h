// Collects a part of a report in a child process, so that neither a program or device that hangs
// nor a crash stops the report.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <signal.h>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/cli/report/tar_file.h"

namespace merlin::cli {

// The folder into which a part of a report writes its files, with sentences about what is missing.
class PartFolder {
 public:
  explicit PartFolder(std::string path) : path_(std::move(path)) {}

  // Returns the path of a file with this name in the folder. In the name, "/" becomes "_", bytes
  // that are not text are escaped, and "_" is put before a dot at the beginning.
  std::string path(const std::string& name) const;
  // Writes a file with this content; if that fails, or `content` is an error, adds a sentence about
  // the missing file.
  void put(const std::string& name, const Result<std::string>& content);
  // Copies the file `from` into the folder; adds a sentence if that fails or the file has more than
  // `most` bytes.
  void copy(const std::string& from, std::size_t most);
  // Adds a sentence about what the part lacks, and why.
  void lacks(const std::string& what) { missing_.push_back(what); }

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::string path_;
  std::vector<std::string> missing_;
};

struct PartSettings {
  std::string name;        // "status"; if `in_folder` is true, also the name of its folder
  bool in_folder = false;  // whether its files are in a folder of their own
  // Time after which the child is ended; the files that it has written until then are kept.
  Duration limit;
  std::size_t most_bytes = 0;                     // limit for all its files together
  std::function<void(PartFolder&)> collect = {};  // called in the child process
};

struct PartResult {
  std::vector<PackedFile> files;     // sorted by name
  std::vector<std::string> missing;  // sentences about what is missing
};

// Collects the part in a child process and returns its files. If the child exceeds its limits or
// crashes, `missing` says so, which is no error. `stop`: the descriptor of stopSignals(); `mask`:
// the signal mask from before stopSignals(), for the child. Errors: kClosed (`stop` is readable),
// kIo (no folder or process could be made). REQUIRES: the process has one thread.
Result<PartResult> runPart(const PartSettings& part, int stop, const sigset_t& mask);

// Runs a program and writes its standard output and errors into the file `path`. To be called by a
// part; the program is killed if the part is ended. Returns its exit status. Errors: kNotFound (the
// program is not installed; the file is removed), kIo.
Result<int> runInto(const std::string& path, const std::vector<std::string>& arguments);

}  // namespace merlin::cli
