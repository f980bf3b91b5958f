// A part of a report. It is collected by a child process, so that neither a hanging program, nor a
// device that does not answer, nor a crash stops the report.
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

// Receives a part's files, and sentences about what it could not get.
class PartFolder {
 public:
  explicit PartFolder(std::string path) : path_(std::move(path)) {}

  // The path of a file of this name in the folder; `/` and bytes that are not text become `_`.
  std::string path(const std::string& name) const;
  // Writes a file; if that fails, or `content` is an error, adds a sentence about what is missing.
  void put(const std::string& name, const Result<std::string>& content);
  // Copies a file of at most `most` bytes.
  void copy(const std::string& from, std::size_t most);
  // Adds a sentence: what the part lacks, and why.
  void lacks(const std::string& what) { missing_.push_back(what); }

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::string path_;
  std::vector<std::string> missing_;
};

struct PartSettings {
  std::string name;            // "status"; with `in_folder` also the name of its folder
  bool in_folder = false;      // its files are in a folder of its own
  Duration limit;              // after that it is ended, and what it has written until then is
                               // taken
  std::size_t most_bytes = 0;  // limit of all its files together
  std::function<void(PartFolder&)> collect = {};  // called in the child
};

struct PartResult {
  std::vector<PackedFile> files;     // by name
  std::vector<std::string> missing;  // sentences
};

// Runs the part. `stop`: the descriptor of stopSignals(); `mask`: the signal mask from before
// stopSignals(). Errors: kClosed (`stop`), kIo (no folder or process could be made). To be called
// while the process has one thread.
Result<PartResult> runPart(const PartSettings& part, int stop, const sigset_t& mask);

// Runs a program, with its output and errors written into the file `path`; the program is ended
// together with the part's process group. Returns its exit status. Errors: kNotFound (it is not
// installed), kIo.
Result<int> runInto(const std::string& path, const std::vector<std::string>& arguments);

}  // namespace merlin::cli
