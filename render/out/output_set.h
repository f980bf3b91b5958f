// OutputSet: all outputs of a wall. A failing output does not affect the others, and the state of
// each is recorded.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/out/output.h"
#include "render/out/picture_checks.h"

namespace merlin::render::out {

struct NamedOutput {
  std::string name, kind;
  std::unique_ptr<Output> output;
};

// What was counted for an output, and its fault.
struct OutputState {
  std::uint64_t frames = 0;  // shown since the start
  std::uint64_t due = 0;     // shown frames that had a deadline, since the start
  std::uint64_t late = 0;    // those of `due` that were shown after their deadline
  std::string fault{};       // why the last frame is not shown; empty: no error
  double lateShare() const {
    return due > 0 ? static_cast<double>(late) / static_cast<double>(due) : 0;
  }
};

// Thread-bound to the wall's thread, except mend(), vblank(), draws() and copyReason().
class OutputSet {
 public:
  explicit OutputSet(std::vector<NamedOutput> outputs);

  std::size_t size() const noexcept { return entries_.size(); }
  const std::string& name(std::size_t i) const { return entries_[i].named.name; }
  const std::string& kind(std::size_t i) const { return entries_[i].named.kind; }
  const OutputState& state(std::size_t i) const { return entries_[i].state; }
  // Returns why output i shows nothing, empty while it works: Output::faultNow(), or else the error
  // of its last present().
  std::string faultNow(std::size_t i) const;
  // Returns the number of frames that output i showed in the second before `now`.
  double shownHz(std::size_t i, Timestamp now) const;

  bool mayTake(std::size_t i, const FrameInfo& info) const {
    return entries_[i].named.output->mayTake(info);
  }

  std::vector<DrawPlace> beginDrawing(std::size_t i) {
    return entries_[i].named.output->beginDrawing();
  }

  // Returns whether at least one output's last signal was drawn in place, not copied
  // (Signal::drawn). Thread-safe.
  bool draws() const;
  // Returns the first Output::copyReason() of an output that is not empty; empty if all are.
  // Thread-safe.
  std::string copyReason() const;

  bool wantsFrame(std::size_t i, Timestamp now) const {
    return entries_[i].named.output->wantsFrame(now) || (checks_ && checks_->wantsFrame(i));
  }

  // Returns output i, so that what it shows can be read back.
  Output& output(std::size_t i) { return *entries_[i].named.output; }
  // Passes to `checks`, from now on, each picture that an output is handed. `checks` must outlive
  // the last present(); null: none.
  void checkWith(PictureChecks* checks) { checks_ = checks; }
  // Returns what the checks have found on output i; kUnchecked without checks.
  PictureState picture(std::size_t i) const { return checks_ ? checks_->state(i) : PictureState{}; }

  // Returns the last vertical blank of the first output that has one; nothing if none has.
  // Thread-safe.
  std::optional<Vblank> vblank() const;

  // Passes a frame to output i and records the result in state(i). `deadline`: when the frame is
  // due; nothing while no motion is shown.
  void present(std::size_t i, const Signal& signal, const FrameInfo& info,
               std::optional<Timestamp> deadline);

  // Calls Output::mend() of each output, also if one of them fails. Returns their messages joined
  // by "; ". Errors: the code of the first one, with all messages.
  Result<std::string> mend();

 private:
  struct Entry {
    explicit Entry(NamedOutput output) : named(std::move(output)) {}
    NamedOutput named;
    OutputState state;
    std::deque<Timestamp> shown;  // times of the frames of the last second
    // Whether the last signal was drawn; an atomic that can be moved.
    std::unique_ptr<std::atomic<bool>> drawn = std::make_unique<std::atomic<bool>>(false);
  };
  std::vector<Entry> entries_;
  PictureChecks* checks_ = nullptr;
};

}  // namespace merlin::render::out
