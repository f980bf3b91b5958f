// BufferTurns: records for each of a display's three buffers whether it is free, being written,
// ready to be committed, committed, or shown.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace merlin::render::out::kms {

// At most one buffer is shown and one is committed but not shown yet, so the wall always has a
// third one to write into. Pure; reentrant.
class BufferTurns {
 public:
  static constexpr std::size_t kCount = 3;

  // The buffer to write the next picture into. `replaces`: true if this buffer held a picture that
  // was never committed and is now overwritten.
  struct Write {
    std::size_t buffer = 0;
    bool replaces = false;
  };
  Write beginWrite();
  void endWrite(std::size_t buffer) { states_[buffer] = State::kReady; }

  // Returns the buffer whose picture waits to be committed; nothing if none waits.
  std::optional<std::size_t> ready() const { return find(State::kReady); }
  // commit(): the waiting picture was committed. flipped(): the display now shows the committed
  // picture, and the buffer shown before is free. REQUIRES for commit(): ready() returns a buffer.
  void commit() { states_[*ready()] = State::kPending; }
  void flipped();
  // Undoes a commit() that failed: the picture waits again, or is dropped if a newer one waits.
  void uncommit();

  // Drops the picture that waits to be committed, if there is one.
  void drop();

  bool isPending() const { return find(State::kPending).has_value(); }

 private:
  enum class State { kFree, kWriting, kReady, kPending, kShown };
  std::optional<std::size_t> find(State state) const;

  std::array<State, kCount> states_{};
};

}  // namespace merlin::render::out::kms
