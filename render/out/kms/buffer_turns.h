// BufferTurns: which of a display's three buffers is written, waits, is on its way or is shown.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace merlin::render::out::kms {

// One buffer is shown, one may be on its way to the display, and one is left, so that the wall can
// always write. Pure; reentrant.
class BufferTurns {
 public:
  static constexpr std::size_t kCount = 3;

  // The buffer to write the next picture into. `replaces`: a picture waited that was never
  // committed; the new one takes its place.
  struct Write {
    std::size_t buffer = 0;
    bool replaces = false;
  };
  Write beginWrite();
  void endWrite(std::size_t buffer) { states_[buffer] = State::kReady; }

  // The buffer with the picture that waits to be committed.
  std::optional<std::size_t> ready() const { return find(State::kReady); }
  // Between commit() and flipped() the picture is on its way to the display. commit() REQUIRES:
  // ready() returns a buffer.
  void commit() { states_[*ready()] = State::kPending; }
  void flipped();
  // Undoes a commit() that failed: the picture waits again, or is dropped if a newer one waits.
  void uncommit();

  // Drops the picture that waits.
  void drop();

  bool isPending() const { return find(State::kPending).has_value(); }

 private:
  enum class State { kFree, kWriting, kReady, kPending, kShown };
  std::optional<std::size_t> find(State state) const;

  std::array<State, kCount> states_{};
};

}  // namespace merlin::render::out::kms
