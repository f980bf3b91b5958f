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
  // Uses the bindings whose input is of `source`; others, and invalid ones, are ignored.
  // `generation`: of the daemon; a new one tells readers that the counters began again at 0.
  ActionWriter(const std::vector<Binding>& bindings, Source source, std::uint64_t generation,
               shm::SeqSlot<shm::ActionState>& slot);

  void update(const BallSample& ball) noexcept;
  void update(const TouchSample& touch) noexcept;
  // `posture`: the current posture, after its minimum hold time; may be null.
  void update(const GloveSample& glove, const PostureState* posture) noexcept;
  // The panel's button was pressed.
  void press(std::int64_t now_ns) noexcept;
  // The hand has made the gesture of this name.
  void gesture(std::string_view name, std::int64_t now_ns) noexcept;
  // The device is lost: all its inputs end.
  void release(std::int64_t now_ns) noexcept;

  // Writes a sentence, ended by NUL, if bindings name a key of this device by the device's name,
  // and it is not among `keys`: about the first such key. Otherwise `sentence` stays as it is. A
  // key of any device is not meant.
  void sayLackingKey(const DeviceKeys& keys, std::span<char> sentence) const noexcept;

  // For one other thread: replaces the bindings; the writer uses them from its next call on. A
  // binding that was there before goes on; what one held that is no more ends; and a new one does
  // nothing until its input has been seen released, so that a button that is pressed at this moment
  // triggers nothing.
  void rebind(const std::vector<Binding>& bindings);
  // Uses new bindings, if there are any, and begins what time alone begins; each of the calls above
  // does so too. To be called now and then while the device sends nothing, and when it is due.
  void adopt(std::int64_t now_ns) noexcept;
  // When time alone begins something next, as long as the inputs stay as they are;
  // Timestamp::max(): never.
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
    // Index of the first binding to this input alone, which is not a chord, and to `with` alone.
    std::size_t alone = kNone, with_alone = kNone;
    bool lasts = false, on_leave = false;
    bool pressed = false;   // the input, and the one with it
    bool was_held = false;  // pressed for long enough
    bool waits = false;     // until the input has been seen released
    bool in_chord = false;  // of the first binding to an input alone: a chord with it is pressed
    bool chorded = false;   // one was at some time of this press, so that nothing begins any more
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
  std::uint32_t axes_ = 0;  // that are pushed: pushedAxes()
  Pinch pinch_;             // of a touch surface's fingers
  ParsedBindings bindings_;
  std::unique_ptr<Handover<ParsedBindings>> rebound_;  // a pointer, since a writer is moved
  shm::ActionState state_{};
  shm::SeqSlot<shm::ActionState>& slot_;
};

}  // namespace merlin::actions
