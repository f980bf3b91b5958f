// Displays: the displays of one card that the wall uses: finds them, lights them, and commits each
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

// The wall's thread calls present(), one thread step(), and one readBack(), for the object's whole
// life; the rest is thread-safe. No fault ends it: neither a missing card, connector or mode, nor
// an unplugged display, nor another program that has the displays. present() returns the fault as
// an error for the outputs that it concerns, and the fault is checked again once a second.
class Displays {
 public:
  using OpenCard = std::function<Result<std::unique_ptr<Card>>()>;

  // `clock` outlives this.
  Displays(OpenCard open, const Clock& clock);
  ~Displays();
  Displays(const Displays&) = delete;
  Displays& operator=(const Displays&) = delete;

  // Adds an output and returns its number. To be called before the first present() and step(). An
  // output with the connector "*" (KmsSettings::isEvery()) is shown on each connector that has a
  // display and that no other output names, up to kMostOfEvery. It is no fault of such an output if
  // there is no such connector, or no card.
  std::size_t add(const KmsSettings& settings, int picture_width, int picture_height);
  static constexpr std::size_t kMostOfEvery = 16;

  // Where the next picture of output i may be drawn by a GPU: a buffer of each of its displays that
  // is neither shown nor on its way to the display. A place's buffer is null if the card's driver
  // does not share its memory. Returns no place if none of the output's displays takes part in
  // commits. Once a picture was not drawn into the places that were returned, or showAgain() was
  // called, returns none until the display has other buffers. Called by present()'s thread, which
  // then calls present() for this output next; nothing is committed meanwhile.
  std::vector<DrawPlace> beginDrawing(std::size_t i);

  // Why pictures are copied to a display of output i that takes part in commits, with the display's
  // name: the card's driver does not share its memory, or showAgain() was called after a picture
  // had been drawn there. Empty: neither is so.
  std::string copyReason(std::size_t i) const;

  // Writes the picture (RGBA, rows from top to bottom without padding) of frame `sequence` into a
  // buffer of each display of output i; `rgba` empty: it is drawn into those of beginDrawing(). A
  // frame is committed when all outputs have their pictures of it. Never waits for a display. Cost:
  // one pass over the pixels for each. Returns when the picture was handed over; nothing if it
  // replaced one that was not committed yet, or if the card was not looked at yet. Errors: why the
  // output shows no picture.
  Result<std::optional<Timestamp>> present(std::size_t i, std::span<const std::uint8_t> rgba,
                                           std::uint64_t sequence);

  // True if output i could show a picture and has none.
  bool wantsFrame(std::size_t i) const;

  // Why output i shows no picture; empty: it shows one, or the card was not looked at yet.
  std::string fault(std::size_t i) const;

  // What a display of an output was found to show.
  struct Reading {
    std::string connector;
    FoundPicture found;
    std::string programs{};  // if the picture is foreign: other programs that have the card open
  };
  // Reads from the kernel, and not from this object's records, what is shown by each display of
  // output i that shows its frames. Takes milliseconds; no frame waits for it. Errors: the first
  // reason why a display cannot be read.
  Result<std::vector<Reading>> readBack(std::size_t i);
  // Sets the modes of output i's displays again with its next frame, and asks for that frame.
  void showAgain(std::size_t i);

  // The last vertical blank of the first display that counts them, and the time between two.
  struct Blanks {
    Timestamp last{};
    Duration period{};
  };
  std::optional<Blanks> blanks() const;

  // Looks for changes if a second has passed, commits the frame that is due, and waits for at most
  // `longest` for something to do.
  void step(Duration longest);
  void wake();
  // Waits until step() has looked for the card for the first time, but at most `longest`.
  void awaitFirstLook(Duration longest);

 private:
  // The display on which a screen is shown, with its buffers.
  struct Place {
    Id connector = 0, crtc = 0, plane = 0;
    Mode mode{};
    std::string name{};  // of the connector
    std::array<std::shared_ptr<Buffer>, BufferTurns::kCount> buffers{};
    BufferTurns turns{};
    // Nothing is drawn into its buffers: a try has failed, or the checks found another picture.
    bool copies = false;
    bool was_drawn = false;     // into one of its buffers
    std::string copy_reason{};  // for copyReason()
  };
  struct Screen {
    KmsSettings settings{};
    std::size_t output = 0;
    std::optional<std::size_t> nth{};  // connector "*": which of the free connectors
    int width = 0, height = 0;         // of the picture [px]
    // Shared with present(), which may still write when a display gets another mode.
    std::shared_ptr<Place> place{};
    bool lit = false;                     // takes part in commits
    bool sets_mode = false;               // in the next commit
    std::string fault{};                  // why no picture is shown; empty: one is
    std::optional<Timestamp> retry_at{};  // when to try again after the card refused it
    std::atomic<bool> wants_frame{false};
    bool again = false;  // showAgain() was called
  };
  // A picture on its way into a buffer of a display. `replaces`: as in BufferTurns::Write.
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
  // A screen's share of a commit.
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
  std::unique_ptr<Card> card_;        // replaced by step() with the mutex held, used by it without
  std::shared_ptr<Scanout> scanout_;  // of card_, since it became master; shared with readBack()
  std::deque<Screen> screens_;        // by output; a deque, since a Screen cannot be moved
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
