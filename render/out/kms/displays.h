// Displays: finds the displays of one card that the wall uses, sets their modes, and commits each
// frame for all of them at once.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "render/out/kms/buffer_turns.h"
#include "render/out/kms/card.h"
#include "render/out/kms/settings.h"
#include "render/out/picture/draw_place.h"
#include "render/out/picture/picture_judge.h"

namespace merlin::render::out::kms {

// beginDrawing() and present() are called by the wall's thread, step() by a second one and
// readBack() by a third; the rest is thread-safe. A missing card, connector or mode, an unplugged
// display or another program that is DRM master does not end the work: present() returns the fault
// for the outputs that it concerns, and step() checks once a second whether it is gone.
class Displays {
 public:
  using OpenCard = std::function<Result<std::unique_ptr<Card>>()>;

  // `clock` outlives this.
  Displays(OpenCard open, const Clock& clock);
  ~Displays();
  Displays(const Displays&) = delete;
  Displays& operator=(const Displays&) = delete;

  // Adds an output whose picture has this size [px] and returns its number, counted from 0. To be
  // called before the first present() and step(). An output with the connector "*"
  // (KmsSettings::isEvery()) is shown on each connector that has a display and that no other output
  // names, up to kMostOfEvery. Such an output has no fault if there is no such connector or no
  // card.
  std::size_t add(const KmsSettings& settings, int picture_width, int picture_height);
  static constexpr std::size_t kMostOfEvery = 16;

  // Returns where a GPU may draw the next picture of output i: for each of its displays that takes
  // part in commits, a buffer that is neither shown nor committed. A place's buffer is null if the
  // card's driver does not share its memory. Returns no place if no display takes part. Also
  // returns none after a picture was not drawn into the returned places, or after showAgain(),
  // until the display has other buffers. Called by present()'s thread, whose next call must be
  // present() for this output; nothing is committed in between.
  std::vector<DrawPlace> beginDrawing(std::size_t i);

  // Returns why pictures are copied to a display of output i that takes part in commits, after the
  // display's name: the card's driver does not share its memory, or showAgain() was called after a
  // picture had been drawn there. Empty: neither is the case.
  std::string copyReason(std::size_t i) const;

  // Hands over the picture of frame `sequence` to each display of output i. `rgba`: its pixels,
  // RGBA, rows from top to bottom without padding, which are copied; empty: it was drawn into the
  // places of beginDrawing(). Outputs present a frame in the order of their numbers; step() commits
  // it after the last one. Never waits for a display. Cost: one pass over the pixels for each
  // display. Returns when the picture was handed over; nothing if no display took it, or if it only
  // replaced pictures that were not committed yet. Errors: kIo: why the output shows no picture.
  Result<std::optional<Timestamp>> present(std::size_t i, std::span<const std::uint8_t> rgba,
                                           std::uint64_t sequence);

  // Returns true if a display of output i is ready and needs a picture, since its mode is to be
  // set.
  bool wantsFrame(std::size_t i) const;

  // Returns why output i shows no picture; empty if it does, or if step() has not looked for the
  // card yet.
  std::string fault(std::size_t i) const;

  // The picture that a display of an output was found to show.
  struct Reading {
    std::string connector;
    FoundPicture found;
    std::string programs{};  // if the picture is foreign: other programs that have the card open
  };
  // Returns what each display of output i shows, as the kernel reports it; this object's records
  // are not used. Displays whose mode is still to be set are left out. Takes milliseconds; no frame
  // waits for it. Errors: the first reason why a display cannot be read (kIo, kBusy).
  Result<std::vector<Reading>> readBack(std::size_t i);
  // Makes step() set the modes of output i's displays again with the next frame, and wantsFrame()
  // ask for that frame. From then on pictures are copied to these displays, not drawn.
  void showAgain(std::size_t i);

  // The last vertical blank of the first display whose CRTC counts vertical blanks, and the time
  // between two blanks.
  struct Blanks {
    Timestamp last{};
    Duration period{};
  };
  std::optional<Blanks> blanks() const;

  // Looks for the card and its displays if the last look was a second ago, commits the frame that
  // is complete, and waits at most `longest` for a page flip or wake().
  void step(Duration longest);
  void wake();
  // Waits until step() has looked for the card for the first time, but at most `longest`.
  void awaitFirstLook(Duration longest);

 private:
  // The display on which a screen is shown, with its buffers.
  struct Place {
    Id connector = 0, crtc = 0, plane = 0;
    Mode mode{};
    std::string name{};  // name of the connector
    std::array<std::shared_ptr<Buffer>, BufferTurns::kCount> buffers{};
    BufferTurns turns{};
    // True: pictures are copied into the buffers, since a picture was not drawn there, or the
    // checks found another picture.
    bool copies = false;
    bool was_drawn = false;     // a picture was drawn into one of the buffers
    std::string copy_reason{};  // see Displays::copyReason(); empty: no reason
  };
  struct Screen {
    KmsSettings settings{};
    std::size_t output = 0;
    // For connector "*": index among the connectors that no output names.
    std::optional<std::size_t> nth{};
    int width = 0, height = 0;  // of the picture [px]
    // Shared with present(), which may still write when a display gets another mode.
    std::shared_ptr<Place> place{};
    bool lit = false;                     // takes part in commits
    bool sets_mode = false;               // the next commit sets its mode
    std::string fault{};                  // why no picture is shown; empty: one is
    std::optional<Timestamp> retry_at{};  // when to try again after the card refused it
    std::atomic<bool> wants_frame{false};
    bool again = false;  // showAgain() was called
  };
  // A picture that is being written into a display's buffer. `replaces`: as in BufferTurns::Write.
  struct Write {
    std::shared_ptr<Place> place;
    std::size_t buffer = 0;
    bool replaces = false;
    int width = 0, height = 0;  // of the picture [px]
  };
  // A display that is to be read back.
  struct Target {
    std::shared_ptr<Place> place;
    int width = 0, height = 0;  // of the picture [px]
  };
  // The part of a commit that concerns one screen.
  struct Share {
    Screen* screen = nullptr;
    Lit lit;
  };

  static std::optional<Write> beginWrite(Screen& screen);
  static void copy(std::unique_lock<std::mutex>& lock, const Write& write,
                   std::span<const std::uint8_t> rgba);
  bool endDrawing(std::unique_lock<std::mutex>& lock, std::span<const std::uint8_t> rgba);
  bool openCard();
  void closeCard(const std::string& why);
  void look(Timestamp now);
  bool holdMaster();
  bool hasNewDisplay(const CardContents& contents);
  std::vector<Result<std::size_t>> chooseConnectors(const CardContents& contents) const;
  void arrange(const CardContents& contents, Timestamp now);
  Result<Ok> place(Screen& screen, const CardContents& contents, const Connector& connector,
                   std::optional<std::size_t> crtc);
  static void lightAgain(Screen& screen);
  static void darken(Screen& screen, const std::string& fault);
  void darkenAll(const std::string& fault);
  std::string faultOf(std::size_t output) const;
  void commit(Timestamp now);
  std::vector<Share> dueShares();
  void lightAskedFor();
  static Result<Reading> readOne(Scanout& scanout, const Target& target);
  void settle(std::vector<Share>& shares, const CommitResult& result, Timestamp now);
  void refuse(std::vector<Share>& shares, const std::string& why, Timestamp now);
  void take(const std::vector<Flip>& flips);
  void checkOverdue(Timestamp now);
  std::string takenMessage() const;

  const OpenCard open_;
  const Clock& clock_;
  mutable std::mutex mutex_;  // guards all below except the atomics; not held during slow calls
  std::condition_variable idle_;
  // Replaced by step() with the mutex held, and used by step() without the mutex.
  std::unique_ptr<Card> card_;
  // Reads card_'s displays; null unless card_ is DRM master; shared with readBack().
  std::shared_ptr<Scanout> scanout_;
  // In the order of their outputs; a deque, since a Screen cannot be moved.
  std::deque<Screen> screens_;
  std::size_t outputs_ = 0;
  bool looked_ = false;  // step() has looked for a card at least once
  bool master_ = false;
  bool whole_ = false;  // every output has its picture of the frame `sequence_`
  bool busy_ = false;   // the last commit is to be tried again
  std::uint64_t sequence_ = 0;
  // What beginDrawing() has begun and present() is to end; used by their thread alone.
  std::vector<Write> begun_;
  // These three are used by step() alone.
  std::set<Id> connected_;  // connectors with a display at the last look
  Timestamp next_look_{};
  Timestamp committed_{};
  std::atomic<std::int64_t> vblank_ns_{0}, period_ns_{0};  // 0: none
};

}  // namespace merlin::render::out::kms
