// A part of a report: collected by a child process, so that neither a program that hangs nor a
// device that does not answer nor a crash stops the report.
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

// Where a part puts its files, and what it could not get.
class PartFolder {
 public:
  explicit PartFolder(std::string path) : path_(std::move(path)) {}

  // The path of a file of this name in the folder; `/` and whatever is no text becomes `_`.
  std::string path(const std::string& name) const;
  // Writes a file; says what is missing where that fails or the error is the content.
  void put(const std::string& name, const Result<std::string>& content);
  // Copies a file of at most `most` bytes.
  void copy(const std::string& from, std::size_t most);
  // A sentence: what the part lacks, and why.
  void lacks(const std::string& what) { missing_.push_back(what); }

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::string path_;
  std::vector<std::string> missing_;
};

struct PartSettings {
  std::string name;            // "status"; with `in_folder` the folder of its files too
  bool in_folder = false;      // its files are in a folder of its own
  Duration limit;              // after that it is ended, and what it has written until then is
                               // taken
  std::size_t most_bytes = 0;  // of all its files together
  std::function<void(PartFolder&)> collect = {};  // called in the child
};

struct PartResult {
  std::vector<PackedFile> files;     // by name
  std::vector<std::string> missing;  // sentences
};

// Runs the part. `stop`, `mask`: of stopSignals(), and from before it. Errors: kClosed (`stop`),
// kIo (no folder or process could be made). To be called while the process has one thread.
Result<PartResult> runPart(const PartSettings& part, int stop, const sigset_t& mask);

// Runs a program with its output and its errors in the file `path`, which ends with the process
// group of the part. Returns its exit status. Errors: kNotFound (it is not installed), kIo.
Result<int> runInto(const std::string& path, const std::vector<std::string>& arguments);

}  // namespace merlin::cli
