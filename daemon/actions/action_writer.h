// ActionWriter: turns the state of one device's inputs into the actions that they are bound to, in
// shared memory.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/actions/input.h"
#include "daemon/actions/pinch.h"
#include "daemon/actions/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/handover.h"
#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"

namespace merlin::actions {

// Thread-bound to the device's thread, except rebind(). Takes no lock; allocates nothing after
// construction. Each call costs a comparison per binding of this device and writes only when an
// action begins or ends.
class ActionWriter {
 public:
  // Uses the bindings to inputs of `source`; others, and invalid ones, are ignored. `generation`:
  // that of the daemon; a new one tells readers that the counters restarted at 0.
  ActionWriter(const std::vector<Binding>& bindings, Source source, std::uint64_t generation,
               shm::SeqSlot<shm::ActionState>& slot);

  void update(const BallSample& ball) noexcept;
  void update(const TouchSample& touch) noexcept;
  // `posture`: the current posture, after its minimum hold time; may be null.
  void update(const GloveSample& glove, const PostureState* posture) noexcept;
  // To be called when the panel's button was pressed.
  void press(std::int64_t now_ns) noexcept;
  // To be called when the hand has made the gesture of this name.
  void gesture(std::string_view name, std::int64_t now_ns) noexcept;
  // To be called when the device is lost: ends all its inputs.
  void release(std::int64_t now_ns) noexcept;

  // If a binding names this device and a key that is not among `keys`, writes a NUL-ended sentence
  // about the first such key; otherwise `sentence` stays as it is. Bindings that name no device do
  // not count.
  void sayLackingKey(const DeviceKeys& keys, std::span<char> sentence) const noexcept;

  // For one other thread: replaces the bindings; the writer uses them from its next call on. A
  // binding that existed before continues; an action held by a removed binding ends; a new binding
  // does nothing until its input has been released, so that a button that is pressed at this moment
  // triggers nothing.
  void rebind(const std::vector<Binding>& bindings);
  // Starts to use new bindings, if there are any, and begins the actions that are due by time alone
  // (after_s, repeat_s); each of the calls above does so too. To be called now and then while the
  // device sends nothing, and at due().
  void adopt(std::int64_t now_ns) noexcept;
  // When the next action begins by time alone if the inputs stay as they are; Timestamp::max():
  // never.
  Timestamp due() const noexcept;

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct ParsedBinding {
    Input input;
    std::optional<Input> with;
    std::size_t action = 0;  // index into kActions
    std::int64_t after_ns = 0, repeat_ns = 0;
    std::int64_t since_ns = 0;  // when `pressed` began
    std::int64_t again_ns = 0;  // when the action repeats
    // Indexes of the first bindings, other than chords, to this input alone and to `with` alone.
    std::size_t alone = kNone, with_alone = kNone;
    bool lasts = false, on_leave = false;
    bool pressed = false;   // the input is pressed, and so is `with`
    bool was_held = false;  // pressed for long enough
    bool waits = false;     // does nothing until the input has been seen released
    // Only in the first binding to an input alone: whether a chord with this input is pressed.
    bool in_chord = false;
    bool chorded = false;  // a chord was pressed during this press, so that nothing begins any more
  };
  using ParsedBindings = std::vector<ParsedBinding>;
  ParsedBindings parse(const std::vector<Binding>& bindings) const;
  void setNumber(Input& input) const;
  static void findChords(ParsedBindings& bindings);
  void markChords() noexcept;
  template <typename IsHeld>
  void apply(std::int64_t now_ns, const IsHeld& isHeld) noexcept;
  template <typename Happens>
  void happen(std::int64_t now_ns, const Happens& happens) noexcept;
  void takeBindings(std::int64_t now_ns) noexcept;
  void stepAll(std::int64_t now_ns) noexcept;
  static std::optional<std::int64_t> dueOf(const ParsedBinding& binding) noexcept;
  bool step(ParsedBinding& binding, std::int64_t now_ns) noexcept;
  bool longerOneHeld(const ParsedBinding& binding) const noexcept;
  bool begin(ParsedBinding& binding) noexcept;
  void updateHeld() noexcept;

  Source source_;
  std::uint32_t axes_ = 0;  // axes that are pushed: pushedAxes()
  Pinch pinch_;             // of a touch surface's fingers
  ParsedBindings bindings_;
  std::unique_ptr<Handover<ParsedBindings>> rebound_;  // a pointer, since a writer is moved
  shm::ActionState state_{};
  shm::SeqSlot<shm::ActionState>& slot_;
};

}  // namespace merlin::actions
