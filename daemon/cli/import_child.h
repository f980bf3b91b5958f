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

// Parses the reports of merlin-import, one a line; see daemon/import/merlin_import.cpp. Pure.
class ImportReport {
 public:
  // Takes bytes as they arrive. Lines that are too long or not understood are ignored.
  void take(std::string_view bytes);

  double share() const noexcept { return share_; }           // share of the work that is done, 0..1
  std::uint64_t items() const noexcept { return items_; }    // pixels so far
  std::uint64_t pixels() const noexcept { return pixels_; }  // of the picture; 0: not known yet
  const std::vector<std::string>& lacks() const noexcept { return lacks_; }
  // For the user: what was left out or assumed. At most 16.
  const std::vector<std::string>& notes() const noexcept { return notes_; }
  // Facts about the result as a JSON object, not checked; empty until it is complete.
  const std::string& facts() const noexcept { return facts_; }
  // The name of the result in its folder, once it is complete; or the error.
  const std::optional<Result<std::string>>& result() const noexcept { return result_; }

 private:
  void line(std::string_view text);

  std::string pending_, facts_;
  double share_ = 0;
  std::uint64_t items_ = 0, pixels_ = 0;
  std::vector<std::string> lacks_, notes_;
  std::optional<Result<std::string>> result_;
};

class ImportChild {
 public:
  // Starts merlin-import, which is in the same folder as this program, with these arguments.
  // Errors: kUnsupported (it is not installed), kIo.
  static Result<ImportChild> start(const std::vector<std::string>& arguments);
  ~ImportChild();  // ends it
  ImportChild(ImportChild&& other) noexcept;
  ImportChild(const ImportChild&) = delete;
  ImportChild& operator=(const ImportChild&) = delete;

  // Follows the process until it ends. `stop`: a descriptor that becomes readable when the process
  // is to be ended. `on_progress` is called about ten times a second. Returns the name of the
  // result. Errors: those of the import; kClosed (`stop`); kTimeout (no progress for `patience`);
  // kMalformed (it ended by a signal, or above a limit).
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
