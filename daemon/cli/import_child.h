// ImportChild: runs the program merlin-import, which reads a file in a sandbox (daemon/import), and
// follows its reports.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {

// Parses the reports of merlin-import, one per line, in the format of
// daemon/import/merlin_import.cpp. Pure.
class ImportReport {
 public:
  // Parses bytes as they arrive, in pieces of any size. Lines are truncated to 8192 bytes; unknown
  // lines are ignored.
  void take(std::string_view bytes);

  // Share of the work that is done, 0 to 1.
  double share() const noexcept { return share_; }
  // Number of items (such as pixels) that are done.
  std::uint64_t items() const noexcept { return items_; }
  // Number of pixels of the picture; 0: not known yet.
  std::uint64_t pixels() const noexcept { return pixels_; }
  // What the system lacks, so that merlin-import runs without it; at most 16.
  const std::vector<std::string>& lacks() const noexcept { return lacks_; }
  // Sentences for the user about what was left out or assumed; at most 16.
  const std::vector<std::string>& notes() const noexcept { return notes_; }
  // Facts about the result, the text of a JSON object that is not checked; empty until the result
  // is complete.
  const std::string& facts() const noexcept { return facts_; }
  // The file name of the result in its folder, or the error; nothing while the import runs.
  const std::optional<Result<std::string>>& result() const noexcept { return result_; }

 private:
  void line(std::string_view text);

  std::string pending_, facts_;
  double share_ = 0;
  std::uint64_t items_ = 0, pixels_ = 0;
  std::vector<std::string> lacks_, notes_;
  std::optional<Result<std::string>> result_;
};

// A running process of merlin-import.
class ImportChild {
 public:
  // Starts merlin-import, which must be in the same folder as this program, with these arguments.
  // Errors: kUnsupported (it is not installed), kIo.
  static Result<ImportChild> start(const std::vector<std::string>& arguments);
  ~ImportChild();  // kills the process if it still runs
  ImportChild(ImportChild&& other) noexcept;
  ImportChild(const ImportChild&) = delete;
  ImportChild& operator=(const ImportChild&) = delete;

  // Waits until the process ends, and reads its reports. `stop`: a descriptor that becomes readable
  // when the process is to be ended. `on_progress` is called whenever the reported share of the
  // work has changed. Returns the file name of the result. Errors: those that the process reports;
  // kClosed (`stop`); kTimeout (the share has not changed for `patience`); kMalformed (a signal
  // ended the process, also at a resource limit); kIo (it ended without a result). After an error
  // the process may still run until the destructor kills it.
  Result<std::string> follow(int stop, const std::function<void(const ImportReport&)>& on_progress,
                             Duration patience = kPatience);

  const ImportReport& report() const noexcept { return report_; }

  static constexpr Duration kPatience = std::chrono::minutes(1);

 private:
  ImportChild(pid_t pid, UniqueFd output) : pid_(pid), output_(std::move(output)) {}
  bool read();
  Result<std::string> ended();

  pid_t pid_;
  UniqueFd output_;
  ImportReport report_;
};

}  // namespace merlin::cli
