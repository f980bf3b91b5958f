#include "daemon/actions/action_writer.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
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
    ParsedBinding& p = parsed.emplace_back();
    p.input = *std::move(input);
    if (!binding.with.empty()) p.with = parseInput(binding.with);
    setNumber(p.input);
    if (p.with) setNumber(*p.with);
    p.action = static_cast<std::size_t>(action - kActions.begin());
    p.lasts = isHeldAction(binding.action);
    p.on_leave = binding.when == When::kLeave;
    p.after_ns = fromSeconds(binding.after_s).count();
    p.repeat_ns = fromSeconds(binding.repeat_s).count();
  }
  findChords(parsed);
  return parsed;
}

// All bindings are to inputs of one source, so the device of an input need not be compared.
void ActionWriter::findChords(ParsedBindings& bindings) {
  std::map<std::tuple<Input::Kind, std::uint32_t, std::string>, std::size_t> alone;
  const auto partOf = [](const Input& i) { return std::tuple(i.kind, i.button, i.name); };
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    if (!bindings[i].with) alone.emplace(partOf(bindings[i].input), i);
  }
  const auto indexOf = [&](const Input& input) {
    const auto found = alone.find(partOf(input));
    return found == alone.end() ? kNone : found->second;
  };
  for (ParsedBinding& binding : bindings) {
    binding.alone = indexOf(binding.input);
    if (binding.with) binding.with_alone = indexOf(*binding.with);
  }
}

void ActionWriter::setNumber(Input& input) const {
  if (input.kind == Input::Kind::kKey && source_.key_code)
    input.button = source_.key_code(input.name).value_or(0);
}

void ActionWriter::rebind(const std::vector<Binding>& bindings) {
  rebound_->offer(parse(bindings));
}

void ActionWriter::adopt(std::int64_t now_ns) noexcept {
  takeBindings(now_ns);
  stepAll(now_ns);
}

void ActionWriter::takeBindings(std::int64_t now_ns) noexcept {
  const auto carryOver = [](const ParsedBindings& before, ParsedBindings& now) {
    for (ParsedBinding& binding : now) {
      const auto same = std::find_if(before.begin(), before.end(), [&](const ParsedBinding& b) {
        return b.input == binding.input && b.with == binding.with && b.action == binding.action &&
               b.on_leave == binding.on_leave;
      });
      binding.waits = same == before.end() || same->waits;
      if (same == before.end()) continue;
      binding.pressed = same->pressed;
      binding.since_ns = same->since_ns;
      binding.was_held = same->was_held;
      binding.again_ns = same->again_ns;
      binding.chorded = same->chorded;
    }
  };
  if (!rebound_->take(bindings_, carryOver)) return;
  const shm::ActionState before = state_;
  updateHeld();
  if (std::equal(std::begin(before.held), std::end(before.held), std::begin(state_.held))) return;
  state_.changed_ns = now_ns;
  slot_.publish(state_);
}

// Counts the action as begun. Returns true: the state has changed.
bool ActionWriter::begin(ParsedBinding& binding) noexcept {
  ++state_.begun[binding.action];
  state_.recent[state_.sequence++ % std::size(state_.recent)] =
      static_cast<std::uint8_t>(binding.action);
  return true;
}

// Whether a binding to the same input with a longer after_s has begun. If so, the release of the
// input ends that binding, and is not the end of a short press.
bool ActionWriter::longerOneHeld(const ParsedBinding& binding) const noexcept {
  return std::any_of(bindings_.begin(), bindings_.end(), [&](const ParsedBinding& other) {
    return other.after_ns > binding.after_ns && other.input == binding.input && other.was_held;
  });
}

// Marks the bindings to a single input that is now pressed as a part of a chord: only the chord
// acts then. Cost: linear.
void ActionWriter::markChords() noexcept {
  for (ParsedBinding& binding : bindings_) binding.in_chord = false;
  for (const ParsedBinding& chord : bindings_) {
    if (!chord.with || !chord.pressed) continue;
    for (const std::size_t alone : {chord.alone, chord.with_alone}) {
      if (alone != kNone) bindings_[alone].in_chord = true;
    }
  }
  for (ParsedBinding& binding : bindings_) {
    if (!binding.with && binding.pressed && bindings_[binding.alone].in_chord)
      binding.chorded = true;
  }
}

// Begins, repeats or ends the action of a binding. Returns whether the state has changed. An action
// that is already held continues when its input becomes part of a chord.
bool ActionWriter::step(ParsedBinding& binding, std::int64_t now_ns) noexcept {
  const bool held = binding.pressed && now_ns - binding.since_ns >= binding.after_ns &&
                    (binding.was_held || !binding.chorded);
  if (held == binding.was_held) {
    if (!held || binding.repeat_ns == 0 || now_ns < binding.again_ns || binding.chorded)
      return false;
    // The next repetition is counted from the planned time of this one, so that delays do not add
    // up; but from now if that would already be over.
    binding.again_ns += binding.repeat_ns;
    if (binding.again_ns <= now_ns) binding.again_ns = now_ns + binding.repeat_ns;
    return begin(binding);
  }
  const bool cancelled = binding.on_leave && (longerOneHeld(binding) || binding.chorded);
  binding.was_held = held;
  if (binding.lasts && !held) return true;
  if ((!binding.lasts && held == binding.on_leave) || cancelled) return false;
  binding.again_ns = now_ns + binding.repeat_ns;
  return begin(binding);
}

// Returns the time at which step() has something to do although no input changes; nothing: never.
std::optional<std::int64_t> ActionWriter::dueOf(const ParsedBinding& binding) noexcept {
  if (!binding.pressed || binding.chorded) return std::nullopt;
  if (!binding.was_held) return binding.since_ns + binding.after_ns;
  if (binding.repeat_ns > 0) return binding.again_ns;
  return std::nullopt;
}

Timestamp ActionWriter::due() const noexcept {
  Timestamp first = Timestamp::max();
  for (const ParsedBinding& binding : bindings_) {
    if (const auto due = dueOf(binding)) first = std::min(first, fromNanoseconds(*due));
  }
  return first;
}

// Bindings that act when their input ends come first, so that longerOneHeld() still sees whether a
// longer press was held.
void ActionWriter::stepAll(std::int64_t now_ns) noexcept {
  bool changed = false;
  for (const bool on_leave : {true, false}) {
    for (ParsedBinding& binding : bindings_) {
      if (binding.on_leave == on_leave) changed = step(binding, now_ns) || changed;
    }
  }
  if (!changed) return;
  updateHeld();
  state_.changed_ns = now_ns;
  slot_.publish(state_);
}

void ActionWriter::updateHeld() noexcept {
  std::fill(std::begin(state_.held), std::end(state_.held), std::uint8_t{0});
  for (const ParsedBinding& binding : bindings_) {
    if (binding.lasts && binding.was_held) state_.held[binding.action] = 1;
  }
}

template <typename IsHeld>
void ActionWriter::apply(std::int64_t now_ns, const IsHeld& isHeld) noexcept {
  takeBindings(now_ns);
  for (ParsedBinding& binding : bindings_) {
    const bool pressed = isHeld(binding.input) && (!binding.with || isHeld(*binding.with));
    if (binding.waits) {
      binding.waits = pressed;
      continue;
    }
    if (pressed && !binding.pressed) {
      binding.since_ns = now_ns;
      binding.chorded = false;
    }
    binding.pressed = pressed;
  }
  markChords();
  stepAll(now_ns);
}

void ActionWriter::update(const BallSample& ball) noexcept {
  axes_ = pushedAxes(ball, axes_);
  const std::uint32_t held = ball.buttons | axes_;
  apply(ball.received_ns, [&](const Input& input) {
    if (input.kind != Input::Kind::kKey) return (held & input.button) != 0;
    return input.button != 0 && std::find(std::begin(ball.keys), std::end(ball.keys),
                                          input.button) != std::end(ball.keys);
  });
}

void ActionWriter::update(const TouchSample& touch) noexcept {
  const std::uint32_t pinched = pinch_.update(touch);
  apply(touch.received_ns, [&](const Input& input) {
    if (input.kind == Input::Kind::kPinch) return (pinched & input.button) != 0;
    const std::uint32_t bit = input.button - kFirstMouseButton;  // other keys: wraps, large
    return bit < 16 && (touch.buttons >> bit & 1) != 0;
  });
}

void ActionWriter::update(const GloveSample& glove, const PostureState* posture) noexcept {
  const std::string_view name = posture ? std::string_view(posture->name) : std::string_view();
  apply(glove.received_ns, [&](const Input& input) {
    if (input.kind == Input::Kind::kPosture) return input.name == name;
    return (glove.flags & GloveSample::kWristSwitch) != 0;
  });
}

// A momentary input is reported as released, pressed and released again.
template <typename Happens>
void ActionWriter::happen(std::int64_t now_ns, const Happens& happens) noexcept {
  apply(now_ns, [](const Input&) { return false; });
  apply(now_ns, happens);
  apply(now_ns, [](const Input&) { return false; });
}

void ActionWriter::press(std::int64_t now_ns) noexcept {
  happen(now_ns, [](const Input&) { return true; });
}

void ActionWriter::gesture(std::string_view name, std::int64_t now_ns) noexcept {
  happen(now_ns, [&](const Input& input) { return input.name == name; });
}

void ActionWriter::release(std::int64_t now_ns) noexcept {
  apply(now_ns, [](const Input&) { return false; });
}

void ActionWriter::sayLackingKey(const DeviceKeys& keys, std::span<char> sentence) const noexcept {
  const auto lacks = [&](const Input& input) {
    const bool named = input.kind == Input::Kind::kKey && !input.device.empty();
    return named && (input.button >= keys.size() || !keys[input.button]);
  };
  for (const ParsedBinding& binding : bindings_) {
    const Input* const lacking = lacks(binding.input)                   ? &binding.input
                                 : binding.with && lacks(*binding.with) ? &*binding.with
                                                                        : nullptr;
    if (!lacking) continue;
    std::string_view name = lacking->name;
    const bool is_button = name.starts_with("btn_");
    name.remove_prefix(4);  // removes "btn_" or "key_"
    const std::string_view parts[] = {
        is_button ? "it has no button." : "it has no key.", name,
        ", which a binding names; `merlin devices` lists the keys that it has"};
    std::size_t length = 0;
    for (const std::string_view part : parts) {
      const std::size_t fits = std::min(part.size(), sentence.size() - 1 - length);
      std::copy_n(part.begin(), fits, sentence.begin() + static_cast<std::ptrdiff_t>(length));
      length += fits;
    }
    sentence[length] = '\0';
    return;
  }
}

}  // namespace merlin::actions
