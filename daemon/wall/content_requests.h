// ContentRequests: what people ask the wall to show: contents of the configuration by name, and
// files in the content folder.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/settings.h"
#include "daemon/base/result.h"
#include "daemon/wall/attendance.h"
#include "daemon/wall/missing_contents.h"
#include "daemon/wall/model_watch.h"
#include "daemon/wall/shown_folder.h"
#include "daemon/wall/wall_contents.h"
#include "daemon/wall/wall_loop.h"

namespace merlin::wall {

// All of them outlive ContentRequests.
struct ContentRequestParts {
  const WallSettings& wall;
  const std::vector<ContentEntry>& entries;  // the contents of the configuration
  const MissingContents& missing;            // which of `entries` cannot be shown yet
  ModelWatch& watch;                         // reads models, and reports
  Attendance& attendance;                    // a request is a touch
  const std::atomic<WallLoop*>& loop;        // null before the first frame
};

// Thread-safe, but for makeFolder().
class ContentRequests {
 public:
  explicit ContentRequests(const ContentRequestParts& parts);

  // Makes the content folder; reports as an event why that cannot be done. To be called once, as
  // the daemon starts.
  void makeFolder();

  // Shows the content of that name: one of the configuration, else one of namesInFolder(), by
  // showFile(). Returns the number of the request: when it is done, shm::WallContent::finished is
  // that number. Errors: kBusy, kInvalidArgument (no such name), those of showFile().
  Result<std::uint32_t> show(const std::string& name);

  // The same for a file in the content folder, by its name there; removes files that are no longer
  // needed there. Errors: kBusy, those of ShownFolder::entryOf() and readContent(); a model's file
  // is read later, so its errors are reported with `finished`. Reads a picture's coarsest level, a
  // few milliseconds.
  Result<std::uint32_t> showFile(const std::string& name);

  const ShownFolder& folder() const noexcept { return folder_; }

  // The names of the contents in the content folder that show() accepts, i.e. without those whose
  // name a configured content has; the newest first, 50 at most.
  std::vector<std::string> namesInFolder() const;

  // Names of contents that cannot be shown yet, each with the reason.
  std::vector<std::pair<std::string, std::string>> missing() const;

 private:
  Error noSuchName(const std::string& name) const;
  Result<Ok> showEntry(const ContentEntry& entry, std::uint32_t request);

  ContentRequestParts parts_;
  ShownFolder folder_;
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace merlin::wall
