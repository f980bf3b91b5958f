// ActionWriter: determines from the inputs of one device, hand or panel which actions begin, are
// held and end, and publishes them in shared memory.
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

// Thread-bound to the thread of the device, hand or panel, except rebind(). Takes no lock, and
// allocates nothing after construction except in rebind(). Each call is linear in the number of
// this source's bindings, and writes to shared memory only if an action begins or ends.
class ActionWriter {
 public:
  // Uses those of `bindings` that bind inputs of `source`; ignores all others and invalid ones.
  // `generation`: number of the daemon's run; readers see from a new number that the counters
  // restarted at 0. `slot`: where the actions are published; must outlive this object.
  ActionWriter(const std::vector<Binding>& bindings, Source source, std::uint64_t generation,
               shm::SeqSlot<shm::ActionState>& slot);

  void update(const BallSample& ball) noexcept;
  void update(const TouchSample& touch) noexcept;
  // `posture`: the current posture, i.e. one that was held for the minimum time; null: none.
  void update(const GloveSample& glove, const PostureState* posture) noexcept;
  // To be called each time that the panel's button was pressed.
  void press(std::int64_t now_ns) noexcept;
  // To be called each time that the hand has made the gesture of this name.
  void gesture(std::string_view name, std::int64_t now_ns) noexcept;
  // Ends all inputs, and thus the actions that they hold. To be called when the device is lost.
  void release(std::int64_t now_ns) noexcept;

  // If a binding names a key of this device that is not among `keys`, writes a NUL-ended message
  // about the first such key to `sentence`, cut off if it is too long; otherwise `sentence` does
  // not change. Bindings that do not name a device are ignored. REQUIRES: `sentence` is not empty.
  void sayLackingKey(const DeviceKeys& keys, std::span<char> sentence) const noexcept;

  // Replaces the bindings. May be called by one other thread; the writer uses the new bindings from
  // its next call on. A binding with the same inputs and action as an old one continues in its
  // state. An action that a removed binding holds ends. A new binding does nothing until its input
  // has been released, so that a button that is pressed at this moment triggers nothing.
  void rebind(const std::vector<Binding>& bindings);
  // Uses the bindings of rebind(), if there are new ones, and begins the actions that become due
  // without a new input (after_s, repeat_s). update(), press(), gesture() and release() do this
  // too. To be called at due(), and several times a second while the device sends nothing.
  void adopt(std::int64_t now_ns) noexcept;
  // Returns the time at which the next action begins if the inputs do not change; Timestamp::max():
  // never.
  Timestamp due() const noexcept;

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct ParsedBinding {
    Input input;
    std::optional<Input> with;
    std::size_t action = 0;  // index into kActions
    std::int64_t after_ns = 0, repeat_ns = 0;
    std::int64_t since_ns = 0;  // time at which `pressed` became true
    std::int64_t again_ns = 0;  // time of the next repetition of the action
    // Indexes of the first binding to `input` alone (no chord) and of the first one to `with`
    // alone; kNone: there is none.
    std::size_t alone = kNone, with_alone = kNone;
    bool lasts = false, on_leave = false;
    bool pressed = false;   // the input is pressed, and also `with` if there is one
    bool was_held = false;  // the input has been pressed for at least after_ns
    bool waits = false;     // the binding is ignored until its input was released
    // Whether a chord with this input is pressed. Set only in the first binding to the input alone.
    bool in_chord = false;
    bool chorded = false;  // a chord was pressed during this press: no action begins
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
  std::uint32_t axes_ = 0;  // result of the last pushedAxes()
  Pinch pinch_;             // follows the fingers on a touch surface
  ParsedBindings bindings_;
  std::unique_ptr<Handover<ParsedBindings>> rebound_;  // a pointer, so that a writer can be moved
  shm::ActionState state_{};
  shm::SeqSlot<shm::ActionState>& slot_;
};

}  // namespace merlin::actions
