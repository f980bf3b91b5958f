#include "render/out/kms/buffer_turns.h"

#include <algorithm>
#include <cassert>

namespace merlin::render::out::kms {

std::optional<std::size_t> BufferTurns::find(State state) const {
  const auto* const found = std::ranges::find(states_, state);
  if (found == states_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - states_.begin());
}

// If no buffer is ready or free, takes the one of an abandoned write, whose display was replaced
// meanwhile.
BufferTurns::Write BufferTurns::beginWrite() {
  const auto waiting = ready();
  auto buffer = waiting ? waiting : find(State::kFree);
  if (!buffer) buffer = find(State::kWriting);
  assert(buffer);  // at most one is shown and one pending
  states_[*buffer] = State::kWriting;
  return {*buffer, waiting.has_value()};
}

void BufferTurns::flipped() {
  const auto pending = find(State::kPending);
  if (!pending) return;
  if (const auto shown = find(State::kShown)) states_[*shown] = State::kFree;
  states_[*pending] = State::kShown;
}

void BufferTurns::uncommit() {
  const auto pending = find(State::kPending);
  if (pending) states_[*pending] = ready() ? State::kFree : State::kReady;
}

void BufferTurns::drop() {
  if (const auto waiting = ready()) states_[*waiting] = State::kFree;
}

}  // namespace merlin::render::out::kms
