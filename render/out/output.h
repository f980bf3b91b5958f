// Port (an interface): a destination of finished frames. A new kind is a class and a row in
// output_kinds.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/out/frame_clock.h"
#include "render/out/picture/draw_place.h"
#include "render/out/picture/picture_judge.h"

namespace merlin::render::out {

struct FrameInfo {
  std::uint64_t sequence = 0;  // +1 a frame
  Timestamp finished{};        // when its last pixel was drawn
  std::uint32_t cost = 0;      // of the detail drawn, in the content's unit, e.g. triangles
  bool full_detail = false;
};

// The picture that an output is sent.
struct Signal {
  int width = 0, height = 0;               // [px]
  std::span<const std::uint8_t> pixels{};  // RGBA, rows from top to bottom, no padding
  // The picture is in the output's DrawPlaces already; of `pixels`, only digestRows() are valid.
  bool drawn = false;
};

// What one display of an output was found to show.
struct DisplayReading {
  std::string where;  // the display, for a person: "HDMI-A-1"; empty: the output has only one
  FoundPicture found;
  std::string programs{};  // that may have drawn a foreign picture, "Xorg (812)"; empty: unknown
};

// Thread-bound to the wall's thread, except mend(), wantsFrame(), vblank(), readBack(), showAgain()
// and copyReason().
class Output {
 public:
  virtual ~Output() = default;

  // False if present() will certainly skip this frame; it then need not be corrected, and present()
  // gets a signal without pixels.
  virtual bool mayTake(const FrameInfo&) const { return true; }

  // Where the next signal may be drawn, for each display of the output; to be called at most once
  // before each present(). A signal that is drawn there (Signal::drawn) fills all these places, and
  // drawing has finished, when present() is called; a signal that is not drawn is copied, and the
  // output may return no place from then on. Empty: it copies. None of these buffers is shown.
  virtual std::vector<DrawPlace> beginDrawing() { return {}; }

  // Why signals are copied to a display of the output although somebody could draw them, for a
  // person; empty: they are not, or the reason is not the output's. Thread-safe.
  virtual std::string copyReason() const { return {}; }

  // Takes the frame and copies what it keeps. Takes bounded time: it never waits for a reader, an
  // encoder or a disk; a slow output has its own thread. Returns when the frame was or will be
  // shown; nothing if it was skipped because the output has its own rate. Errors: why this frame,
  // or one taken before it, is not shown; the next frame is tried again.
  virtual Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) = 0;

  // Called once a period, also while nothing moves and no frame is presented: for an output that
  // learns on its own that its display is gone or back. Returns why it shows nothing, empty while
  // it works; nullopt: what the last present() returned still holds.
  virtual std::optional<std::string> faultNow() const { return std::nullopt; }

  // True if a frame is to be presented although the picture has not changed, since the output has
  // lost its picture, or has left a frame out and could take one at `now`. Thread-safe.
  virtual bool wantsFrame(Timestamp /*now*/) const { return false; }

  // The last vertical blank of the output's display; nothing if it has none. Thread-safe.
  virtual std::optional<Vblank> vblank() const { return std::nullopt; }

  // True if readBack() may find something.
  virtual bool canReadBack() const { return false; }

  // Reads what is really shown by each of the output's displays that shows frames. May take
  // milliseconds; called on one thread, which is not the wall's. Errors: why it cannot be read.
  virtual Result<std::vector<DisplayReading>> readBack() { return std::vector<DisplayReading>(); }

  // Called when the output was found to show another picture than the one it was sent: sets up
  // again whatever may be wrong. A frame follows. Thread-safe.
  virtual void showAgain() {}

  // Called once a second, from any thread: restores what other processes have removed, e.g. a
  // shared-memory object. Returns a description of what it did, for the log; empty if nothing.
  // Errors: what cannot be restored.
  virtual Result<std::string> mend() { return std::string(); }
};

}  // namespace merlin::render::out
