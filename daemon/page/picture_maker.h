// PictureMaker: JPEG pictures of the wall for browsers, made on a thread of its own while somebody
// looks, and only when the wall's picture has changed.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/panel_pointer.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "daemon/rfb/shown_picture.h"
#include "daemon/rfb/view.h"

namespace merlin::page {

// The kind of picture that a browser requests: a view of the wall, and its size.
struct PictureKind {
  rfb::View view;
  int width = 0;  // at most [px]
  bool operator==(const PictureKind& other) const {
    return view.kind == other.view.kind && view.tile == other.view.tile && width == other.width;
  }
};

struct MadePicture {
  std::uint64_t number = 0;  // differs from that of every other picture; 0: there is none
  std::shared_ptr<const std::string> jpeg;
  int width = 0, height = 0;                 // of the view, before it was made smaller [px]
  std::optional<PanelPointer::Place> panel;  // where the view shows the operator's panel
};

// Thread-safe. Memory: one copy of the wall's frame for each view that somebody looks at.
class PictureMaker {
 public:
  // `first`: the first picture's number, above 0. `rate_hz`: pictures of each kind per second at
  // most. `watch` and `clock` must outlive this.
  PictureMaker(std::string instance, double rate_hz, std::uint64_t first, ThreadWatch& watch,
               Clock& clock);
  ~PictureMaker();
  PictureMaker(const PictureMaker&) = delete;
  PictureMaker& operator=(const PictureMaker&) = delete;

  // Returns the newest picture of this kind. The first call starts making pictures of the kind;
  // this ends when the kind has not been requested for 3 s. Nothing if kMostKinds other kinds are
  // in use.
  std::optional<MadePicture> newest(const PictureKind& kind);

  // Returns a descriptor that is readable if a picture was made since the last clear().
  int fd() const noexcept { return event_.get(); }
  void clear() const noexcept;
  std::uint64_t made() const;  // number of pictures since the start

  static constexpr std::size_t kMostKinds = 6;

 private:
  struct Kind {
    PictureKind kind;
    Timestamp wanted{};  // when it was last requested
    MadePicture made;
    std::uint64_t changes = 0;  // View::changes when `made` was encoded
  };
  struct View {
    rfb::View view;
    std::unique_ptr<rfb::ShownPicture> shown;
    std::uint64_t changes = 0;  // number of times that its pixels have changed
  };
  void loop(const std::stop_token& stop, Progress& progress);
  std::vector<PictureKind> wantedKinds(Timestamp now);
  void makeAll(const std::vector<PictureKind>& kinds, Timestamp now, Progress& progress);
  View& viewOf(const rfb::View& view);
  void dropUnwanted(const std::vector<PictureKind>& kinds);
  void make(const PictureKind& kind, const View& view);
  bool isShownBy(const PictureKind& kind, std::uint64_t changes) const;

  std::string instance_;
  Duration period_;
  Clock& clock_;
  UniqueFd event_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;  // with mutex_
  std::vector<Kind> kinds_;           // guarded by mutex_, as is what follows
  std::uint64_t next_, made_ = 0;
  std::vector<View> views_;  // used by the thread only
  WatchedThread thread_;
};

}  // namespace merlin::page
