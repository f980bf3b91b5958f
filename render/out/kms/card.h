// Card: the port (an interface) to a graphics card's displays, modelled on the kernel's mode
// setting (KMS). Implemented by drm_card and, in tests, by a fake.
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
  bool preferred = false;  // the display reports it as its preferred mode
  // Chosen only if it is named, or if no progressive mode has the picture's size.
  bool interlaced = false;
  int index = 0;  // position in the kernel's list of the connector's modes

  bool sameTiming(const Mode& o) const {
    return width == o.width && height == o.height && refresh_hz == o.refresh_hz &&
           interlaced == o.interlaced;
  }
};

struct Connector {
  Id id = 0;
  std::string name;        // "HDMI-A-1"
  bool connected = false;  // true: a display is plugged in
  bool link_bad = false;   // true: the display gets no signal until its mode is set again
  std::vector<Mode> modes{};
  std::uint32_t crtcs = 0;  // bit i: CardContents::crtcs[i] can drive it
};

// What a card has. A CRTC reads the buffer of a plane and sends it to a connector (scans it out).
struct CardContents {
  std::vector<Connector> connectors;
  std::vector<Id> crtcs;
  // Primary plane of each CRTC in `crtcs`; 0: it has none for XRGB8888.
  std::vector<Id> primary_planes;
};

// A buffer that a CRTC can scan out: bytes B, G, R, unused; rows from top to bottom.
class Buffer {
 public:
  virtual ~Buffer() = default;
  virtual Id id() const = 0;
  virtual std::span<std::uint8_t> bytes() = 0;
  virtual std::size_t pitch() const = 0;  // [bytes] from one row to the next
  // Returns the buffer's memory for a GPU to draw into; null if the card's driver does not share
  // it.
  virtual std::shared_ptr<const DmaBuf> shared() const { return nullptr; }
  // Explains to a person why shared() is null.
  virtual std::string unsharedReason() const {
    return "the driver of the display's card does not share the memory that is displayed";
  }
};

// The settings of one display in a commit.
struct Lit {
  Id connector = 0, crtc = 0, plane = 0, buffer = 0;
  Mode mode{};
  bool sets_mode = false;  // true: sets mode, CRTC and plane; false: changes only the buffer
};

enum class Committed {
  kDone,
  kBusy,       // an earlier flip is not finished: try again later
  kNotMaster,  // this program is not DRM master, so another one controls the displays
  kRefused,    // the card cannot do this
  kGone,       // the card no longer exists
};

struct CommitResult {
  Committed outcome = Committed::kDone;
  std::string why{};  // the reason for kRefused and kGone
};

// A completed page flip: the CRTC's display has shown the committed buffer since `when`.
struct Flip {
  Id crtc = 0;
  Timestamp when{};
};

// What a CRTC scans out, as the kernel reports it.
struct ScannedOut {
  bool is_on = false;    // the CRTC is active, and at least one of its planes has a buffer
  bool covered = false;  // another plane of the CRTC has a buffer too
  Id buffer = 0;         // buffer of the plane that was asked about; 0: it has none
  bool operator==(const ScannedOut&) const = default;
};

// Reads from the kernel what a card's displays are really sent, independently of the wall's own
// records. Thread-bound to one thread, which need not be the card's; may outlive the card.
class Scanout {
 public:
  virtual ~Scanout() = default;
  // Returns the state of a CRTC and of the plane that the wall uses on it. Errors: kIo: the card no
  // longer exists.
  virtual Result<ScannedOut> look(Id crtc, Id plane) = 0;
  // Maps one of the wall's buffers anew and returns the digest of the picture of this size [px] in
  // its middle. Errors: kIo: another program is DRM master, or the card no longer exists.
  virtual Result<PictureDigest> read(Id buffer, int picture_width, int picture_height) = 0;
  // Programs that have the card open besides this one, "Xorg (812)"; empty if none is seen.
  virtual std::vector<std::string> others() const = 0;
};

// Thread-bound, except wake() and the destruction of buffers, which may outlive the card.
class Card {
 public:
  virtual ~Card() = default;  // restores, if DRM master, what the displays showed at the first
                              // becomeMaster(), unless its device file is kept for the next process

  virtual const std::string& path() const = 0;

  // Lists the card's connectors with their modes. `probe`: asks the displays for their modes again,
  // which may take 0.1 s each. Errors: kIo: the card no longer exists.
  virtual Result<CardContents> look(bool probe) = 0;

  // Makes a black buffer of this size [px]. Errors: kIo: the card has no memory for it.
  virtual Result<std::shared_ptr<Buffer>> makeBuffer(int width, int height) = 0;

  // Tries to become DRM master, the only program that may change what the card's displays show.
  // Returns whether this program is DRM master now. To be called before the first commit even if
  // isMaster(), since it saves what the displays show, which is restored at the end.
  virtual bool becomeMaster() = 0;
  virtual bool isMaster() const = 0;
  // Programs that have the card open besides this one, "Xorg (812)"; empty if none is seen.
  virtual std::vector<std::string> others() const = 0;

  // Changes all these displays in one atomic commit and does not wait; a Flip follows for each
  // display. `test_only`: only checks whether the card can do this, and changes nothing.
  virtual CommitResult commit(std::span<const Lit> lit, bool test_only) = 0;

  // Waits until a flip arrives, `longest` is over or wake() is called. Returns the flips that have
  // arrived.
  virtual std::vector<Flip> wait(Duration longest) = 0;
  virtual void wake() = 0;  // thread-safe

  // Returns a reader of what the displays are sent; null if this cannot be read. To be called again
  // each time this program becomes DRM master.
  virtual std::shared_ptr<Scanout> scanout() { return nullptr; }

  // Returns true if this CRTC counts vertical blanks, so that the times of its flips are those of
  // its display. A virtual machine's card often flips at once.
  virtual bool hasVblank(Id crtc) const = 0;
};

}  // namespace merlin::render::out::kms
