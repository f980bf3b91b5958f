#include "daemon/actions/action_writer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "daemon/base/commands.h"

namespace merlin::actions {

ActionWriter::ActionWriter(const std::vector<Binding>& bindings, Source source,
                           std::uint64_t generation, shm::SeqSlot<shm::ActionState>& slot)
    : source_(std::move(source)),
      bindings_(parse(bindings)),
      rebound_(std::make_unique<Handover<ParsedBindings>>()),
      slot_(slot) {
  state_.generation = generation;
  slot_.publish(state_);
}

ActionWriter::ParsedBindings ActionWriter::parse(const std::vector<Binding>& bindings) const {
  static_assert(kActions.size() <= shm::kMostActions);
  ParsedBindings parsed;
  for (const Binding& binding : bindings) {
    auto input = parseInput(binding.input);
    const auto action = std::find(kActions.begin(), kActions.end(), binding.action);
    if (!input || !input->isOf(source_) || action == kActions.end()) continue;
    parsed.push_back({*std::move(input), static_cast<std::size_t>(action - kActions.begin()),
                      isHeldAction(binding.action), binding.when == When::kLeave});
  }
  return parsed;
}

void ActionWriter::rebind(const std::vector<Binding>& bindings) {
  rebound_->offer(parse(bindings));
}

void ActionWriter::adopt(std::int64_t now_ns) noexcept {
  const auto carryOver = [](const ParsedBindings& before, ParsedBindings& now) {
    for (ParsedBinding& binding : now) {
      const auto same = std::find_if(before.begin(), before.end(), [&](const ParsedBinding& b) {
        return b.input == binding.input && b.action == binding.action &&
               b.on_leave == binding.on_leave;
      });
      binding.was_held = same != before.end() && same->was_held;
      binding.waits = same == before.end() || same->waits;
    }
  };
  if (!rebound_->take(bindings_, carryOver)) return;
  const shm::ActionState before = state_;
  updateHeld();
  if (std::equal(std::begin(before.held), std::end(before.held), std::begin(state_.held))) return;
  state_.changed_ns = now_ns;
  slot_.publish(state_);
}

// Returns whether the state changed.
bool ActionWriter::step(ParsedBinding& binding, bool held) noexcept {
  if (binding.waits) {
    binding.waits = held;
    return false;
  }
  if (held == binding.was_held) return false;
  binding.was_held = held;
  if (!binding.lasts && held == binding.on_leave) return false;
  if (binding.lasts && !held) return true;
  ++state_.begun[binding.action];
  state_.recent[state_.sequence++ % std::size(state_.recent)] =
      static_cast<std::uint8_t>(binding.action);
  return true;
}

void ActionWriter::updateHeld() noexcept {
  std::fill(std::begin(state_.held), std::end(state_.held), std::uint8_t{0});
  for (const ParsedBinding& binding : bindings_) {
    if (binding.lasts && binding.was_held) state_.held[binding.action] = 1;
  }
}

template <typename IsHeld>
void ActionWriter::apply(std::int64_t now_ns, const IsHeld& isHeld) noexcept {
  adopt(now_ns);
  bool changed = false;
  for (ParsedBinding& binding : bindings_)
    changed = step(binding, isHeld(binding.input)) || changed;
  if (!changed) return;
  updateHeld();
  state_.changed_ns = now_ns;
  slot_.publish(state_);
}

void ActionWriter::update(const BallSample& ball) noexcept {
  apply(ball.received_ns, [&](const Input& input) { return (ball.buttons & input.button) != 0; });
}

void ActionWriter::update(const GloveSample& glove, const PostureState* posture) noexcept {
  const std::string_view name = posture ? std::string_view(posture->name) : std::string_view();
  apply(glove.received_ns, [&](const Input& input) {
    if (input.kind == Input::Kind::kPosture) return input.posture == name;
    return (glove.flags & GloveSample::kWristSwitch) != 0;
  });
}

// Before a press the button was released.
void ActionWriter::press(std::int64_t now_ns) noexcept {
  apply(now_ns, [](const Input&) { return false; });
  apply(now_ns, [](const Input&) { return true; });
  apply(now_ns, [](const Input&) { return false; });
}

void ActionWriter::release(std::int64_t now_ns) noexcept {
  apply(now_ns, [](const Input&) { return false; });
}

}  // namespace merlin::actions
