// Thumbnails: the wall's contents, with a small picture of each, made on a thread of its own.
//
// Thumbnails of pictures, panoramas and slides are read from the files of these contents. The
// thumbnail of a model is the wall's last picture of the model, taken from the wall's shared
// memory, because a model's file may be larger than this machine's memory, and drawing it would
// cost the wall time. Contents that `merlin show` has brought to the wall get their thumbnails in
// the same way.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/page/documents.h"
#include "daemon/page/showing.h"
#include "daemon/page/shown_pictures.h"
#include "daemon/page/thumbnail_files.h"
#include "daemon/rfb/shown_picture.h"
#include "daemon/shm/segment.h"
#include "render/image/image.h"

namespace merlin::page {

// A picture of a content, read from its file.
struct ReadPicture {
  render::image::Image image;
  bool panorama = false;
};

// A content of the configuration.
struct PageContent {
  std::string name;
  std::string kind;  // "model", "picture", "panorama" or "slides"
  std::string path;  // path of its file, or of its folder
  // Reads its picture, of a few million pixels at most; called on the thumbnails' thread. Empty:
  // only the wall can show it.
  std::function<Result<ReadPicture>()> read;
};

// Thread-safe. Keeps about 20 KB for each content. Pictures of contents that are not in the
// configuration are kept until this ends.
class Thumbnails {
 public:
  // Of `contents` only the first kMost are kept; `files` has models' pictures of earlier runs.
  // `first`: the first picture's number, above 0. `watch` and `clock` must outlive this.
  Thumbnails(const std::string& instance, std::vector<PageContent> contents, ThumbnailFiles files,
             std::uint64_t first, ThreadWatch& watch, Clock& clock);
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  // Returns the contents in the order of the configuration. While this is called at least every 10
  // s, their files are read again once a minute.
  std::vector<ContentState> contents();
  // Returns the contents that are not in the configuration and have a picture.
  std::vector<ShownState> shown() const;
  // Returns the JPEG picture of the content at `place`: its index in contents(), or
  // ShownState::place. Null if there is none.
  std::shared_ptr<const std::string> jpeg(std::uint64_t place) const;

  static constexpr std::size_t kMost = 256;
  static constexpr int kMostWidth = 640, kMostHeight = 240;  // [px]

 private:
  struct Entry {
    ContentState state;
    std::shared_ptr<const std::string> jpeg;
    std::optional<Timestamp> read_at;  // used by the thread only
  };
  void loop(const std::stop_token& stop, Progress& progress);
  void readOne(Timestamp now, Progress& progress);
  void followWall(Timestamp now);
  std::optional<Showing> showing(Timestamp now);
  void readFiles(Progress& progress);
  bool keep(std::size_t place, std::string jpeg);
  void keepModel(std::size_t place, const render::image::Image& image);
  void keepShown(const std::string& name, const render::image::Image& image);
  void note(std::size_t place, const std::string& fault);

  const std::vector<PageContent> contents_;
  const ThumbnailFiles files_;
  Clock& clock_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;  // with mutex_
  std::vector<Entry> entries_;        // guarded by mutex_, except read_at
  ShownPictures shown_;               // guarded by mutex_
  std::optional<Timestamp> asked_;    // guarded by mutex_, as is next_
  std::uint64_t next_;
  // Used by the thread only.
  shm::SegmentFollower<shm::SegmentReader<shm::WallSegment>> wall_;
  rfb::ShownPicture picture_;
  ShowingWatch watch_;
  bool unwritable_ = false;  // whether the last file could not be written
  WatchedThread thread_;
};

// Returns the picture as JPEG, scaled down to kMostWidth and kMostHeight if it is larger. Errors:
// encodeJpeg()'s. REQUIRES: `image` has pixels.
Result<std::string> thumbnailOf(const render::image::Image& image);

}  // namespace merlin::page
