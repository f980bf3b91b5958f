// Port (an interface): a graphics card's displays, as the kernel's mode setting (KMS) offers them.
// Implemented by drm_card and, in tests, by a fake.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/dma_buf.h"
#include "daemon/base/result.h"
#include "render/out/picture/picture_digest.h"

namespace merlin::render::out::kms {

using Id = std::uint32_t;  // the kernel's id of an object; 0: none

struct Mode {
  int width = 0, height = 0;  // [px]
  double refresh_hz = 0;
  bool preferred = false;   // the display prefers it
  bool interlaced = false;  // never chosen unless named
  int index = 0;            // in the kernel's list of the connector's modes

  bool sameTiming(const Mode& o) const {
    return width == o.width && height == o.height && refresh_hz == o.refresh_hz &&
           interlaced == o.interlaced;
  }
};

struct Connector {
  Id id = 0;
  std::string name;        // "HDMI-A-1"
  bool connected = false;  // a display is plugged in
  bool link_bad = false;   // the display has lost the signal until its mode is set again
  std::vector<Mode> modes{};
  std::uint32_t crtcs = 0;  // bit i: CardContents::crtcs[i] can drive it
};

// A CRTC scans out a plane's buffer to a connector.
struct CardContents {
  std::vector<Connector> connectors;
  std::vector<Id> crtcs;
  std::vector<Id> primary_planes;  // of each CRTC in `crtcs`; 0: none takes XRGB
};

// A buffer that a CRTC can scan out: bytes B, G, R, unused; rows from top to bottom.
class Buffer {
 public:
  virtual ~Buffer() = default;
  virtual Id id() const = 0;
  virtual std::span<std::uint8_t> bytes() = 0;
  virtual std::size_t pitch() const = 0;  // [bytes] from one row to the next
  // The same memory for a GPU that draws into it; null if the card's driver does not share it.
  virtual std::shared_ptr<const DmaBuf> shared() const { return nullptr; }
  // Why shared() is null; for a person.
  virtual std::string unsharedReason() const {
    return "the driver of the display's card does not share the memory that is displayed";
  }
};

// One display's share of a commit.
struct Lit {
  Id connector = 0, crtc = 0, plane = 0, buffer = 0;
  Mode mode{};
  bool sets_mode = false;  // otherwise only the buffer is changed
};

enum class Committed {
  kDone,
  kBusy,       // an earlier flip is not finished: try again later
  kNotMaster,  // another program has the displays
  kRefused,    // the card cannot do this
  kGone,       // the card is not there any more
};

struct CommitResult {
  Committed outcome = Committed::kDone;
  std::string why{};  // the reason for kRefused and kGone
};

// A page flip: the CRTC's display shows the committed buffer since `when`.
struct Flip {
  Id crtc = 0;
  Timestamp when{};
};

// What a CRTC scans out, as the kernel reports it.
struct ScannedOut {
  bool is_on = false;    // it has a mode, is active, and its plane has a buffer
  bool covered = false;  // another plane is shown on it as well
  Id buffer = 0;         // the buffer of its plane
  bool operator==(const ScannedOut&) const = default;
};

// Reads from the kernel what a card's displays are really sent, independently of the wall's own
// records. Thread-bound to one thread, which need not be the card's; may outlive the card.
class Scanout {
 public:
  virtual ~Scanout() = default;
  // Errors: kIo: the card is not there any more.
  virtual Result<ScannedOut> look(Id crtc, Id plane) = 0;
  // Returns the digest of the picture in the middle of one of the wall's buffers, which it maps
  // separately. Errors: kIo: another program is DRM master, or the card is not there any more.
  virtual Result<PictureDigest> read(Id buffer, int picture_width, int picture_height) = 0;
  // Programs that have the card open besides this one, "Xorg (812)"; empty if none is seen.
  virtual std::vector<std::string> others() const = 0;
};

// Thread-bound, except wake() and the destruction of buffers, which may outlive the card.
class Card {
 public:
  virtual ~Card() = default;  // restores what the displays showed before open(), if it is master

  virtual const std::string& path() const = 0;

  // `probe`: asks the displays for their modes again, which may take 0.1 s each.
  // Errors: kIo: the card is not there any more.
  virtual Result<CardContents> look(bool probe) = 0;

  // A black buffer. Errors: kIo.
  virtual Result<std::shared_ptr<Buffer>> makeBuffer(int width, int height) = 0;

  // Only one program at a time, the DRM master, may change what a card shows. Returns whether this
  // one is or has become it. Call it before the first commit, even if isMaster(): it saves what the
  // displays show, to be restored at the end.
  virtual bool becomeMaster() = 0;
  virtual bool isMaster() const = 0;
  // Programs that have the card open besides this one, "Xorg (812)"; empty if none is seen.
  virtual std::vector<std::string> others() const = 0;

  // Changes all these displays in one atomic commit and does not wait; a Flip follows for each.
  // `test_only`: only checks whether the card can do it and changes nothing.
  virtual CommitResult commit(std::span<const Lit> lit, bool test_only) = 0;

  // Waits for flips until one arrives, `longest` is over or wake() is called.
  virtual std::vector<Flip> wait(Duration longest) = 0;
  virtual void wake() = 0;  // thread-safe

  // Null if what the displays are sent cannot be read. Create a new one each time this program
  // becomes DRM master.
  virtual std::shared_ptr<Scanout> scanout() { return nullptr; }

  // True if this CRTC counts vertical blanks, so that the times of its flips are those of its
  // display. A virtual machine's card often flips at once.
  virtual bool hasVblank(Id crtc) const = 0;
};

}  // namespace merlin::render::out::kms
