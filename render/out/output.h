// Output: the port (an interface) to a destination of finished frames. A new kind needs a class
// that implements it and a row in output_kinds.cpp.
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
  std::uint64_t sequence = 0;  // number of the frame; increases by 1 with each
  Timestamp finished{};        // when its last pixel was drawn
  std::uint32_t cost = 0;      // cost of the detail drawn, in the content's unit, e.g. triangles
  bool full_detail = false;
};

// The picture that an output is sent.
struct Signal {
  int width = 0, height = 0;               // [px]
  std::span<const std::uint8_t> pixels{};  // RGBA, rows from top to bottom, no padding
  // True: the picture was drawn into the output's DrawPlaces already, and only the rows
  // digestRows() of `pixels` are valid.
  bool drawn = false;
};

// The picture that one display of an output was found to show.
struct DisplayReading {
  std::string where;  // the display, for a person: "HDMI-A-1"; empty: the output has only one
  FoundPicture found;
  // Programs that may have drawn a foreign picture, "Xorg (812)"; empty: unknown.
  std::string programs{};
};

// Thread-bound to the wall's thread, except mend(), wantsFrame(), vblank(), readBack(), showAgain()
// and copyReason().
class Output {
 public:
  virtual ~Output() = default;

  // False if present() will certainly skip this frame; it then need not be corrected, and present()
  // gets a signal without pixels.
  virtual bool mayTake(const FrameInfo&) const { return true; }

  // Returns a place for each display of the output, where the next signal may be drawn; empty: the
  // output copies signals. To be called at most once before each present(). If a signal is drawn
  // (Signal::drawn), all these places hold it, and drawing has finished, when present() is called.
  // If a signal is not drawn, present() copies it, and the output may return no place from then on.
  // None of these buffers is shown.
  virtual std::vector<DrawPlace> beginDrawing() { return {}; }

  // Returns, for a person, why signals are copied to a display of the output although a GPU could
  // draw them there; empty if they are not copied or the output is not the reason. Thread-safe.
  virtual std::string copyReason() const { return {}; }

  // Takes the frame and copies what it keeps. Takes bounded time: it never waits for a reader, an
  // encoder or a disk; a slow output has its own thread. Returns when the frame was or will be
  // shown; nothing if it was skipped because the output has its own rate. Errors: why this frame,
  // or one taken before it, is not shown; the next frame is tried again.
  virtual Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) = 0;

  // Called once a frame period, even while no frame is presented, so that an output can report a
  // display that has gone or returned. Returns why the output shows nothing, empty while it works;
  // nullopt: the result of the last present() still holds.
  virtual std::optional<std::string> faultNow() const { return std::nullopt; }

  // Returns true if a frame is to be presented although the picture has not changed, since the
  // output has lost its picture, or has left a frame out and could take one at `now`. Thread-safe.
  virtual bool wantsFrame(Timestamp /*now*/) const { return false; }

  // The last vertical blank of the output's display; nothing if it has none. Thread-safe.
  virtual std::optional<Vblank> vblank() const { return std::nullopt; }

  // Returns true if readBack() can return a reading.
  virtual bool canReadBack() const { return false; }

  // Reads what is really shown by each of the output's displays that shows frames. May take
  // milliseconds; called on one thread, which is not the wall's. Errors: why it cannot be read.
  virtual Result<std::vector<DisplayReading>> readBack() { return std::vector<DisplayReading>(); }

  // Called when the output shows another picture than the one it was sent: sets its displays up
  // again. A new frame follows. Thread-safe.
  virtual void showAgain() {}

  // Called once a second, from any thread: restores what other processes have removed, e.g. a
  // shared-memory object. Returns a description of what it did, for the log; empty if nothing.
  // Errors: what cannot be restored.
  virtual Result<std::string> mend() { return std::string(); }
};

}  // namespace merlin::render::out
