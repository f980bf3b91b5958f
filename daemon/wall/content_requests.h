// ContentRequests: executes requests to show a content: contents of the configuration by name, and
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

// What ContentRequests needs. All must outlive it.
struct ContentRequestParts {
  const WallSettings& wall;
  const std::vector<ContentEntry>& entries;  // the contents of the configuration
  const MissingContents& missing;            // which of `entries` cannot be shown yet
  ModelWatch& watch;                         // reads models, and reports events
  Attendance& attendance;                    // each request counts as a touch
  const std::atomic<WallLoop*>& loop;        // null while the loop does not run
};

// Thread-safe, except for makeFolder().
class ContentRequests {
 public:
  explicit ContentRequests(const ContentRequestParts& parts);

  // Creates the content folder if it is missing; if this fails, an event reports the reason. To be
  // called once, at the daemon's start.
  void makeFolder();

  // Shows the content with this name: that of the configuration, or, if there is none, that of the
  // content folder, as showFile() does. Returns the number of the request;
  // shm::WallContent::finished has this number when the request is done. Errors: kBusy (the wall's
  // loop does not run yet), kInvalidArgument (there is no such name, or its file cannot be read
  // yet), those of showFile().
  Result<std::uint32_t> show(const std::string& name);

  // Shows a file in the content folder by its file name, and removes files there that are no longer
  // needed (ShownFolder::tidy()). Returns the number of the request as show() does. Errors: kBusy
  // (the wall's loop does not run yet), those of ShownFolder::entryOf() and readContent(). A
  // model's file is read after the return, so its errors are reported by shm::WallContent::refused.
  // Of a picture, the coarsest level is read before the return, which takes a few milliseconds.
  Result<std::uint32_t> showFile(const std::string& name);

  const ShownFolder& folder() const noexcept { return folder_; }

  // Returns the names of the contents in the content folder that show() accepts, newest first, at
  // most 50. Names that a configured content has are omitted.
  std::vector<std::string> namesInFolder() const;

  // Returns the names of configured contents that cannot be shown yet, each with the reason.
  std::vector<std::pair<std::string, std::string>> missing() const;

 private:
  Error noSuchName(const std::string& name) const;
  Result<Ok> showEntry(const ContentEntry& entry, std::uint32_t request);

  ContentRequestParts parts_;
  ShownFolder folder_;
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace merlin::wall
