#include "daemon/shm/fields.h"

#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "daemon/base/commands.h"

namespace merlin::shm {
namespace {

void addHeader(FieldTable& t) {
  t.bare("segment", 0);
  addTableHeader<Header>(t);
  t.add<std::int64_t>("heartbeat_ns", offsetof(Header, heartbeat_ns), "ns");
  MERLIN_FIELD(t, Header, started_ns, "ns");
  t.add<std::int64_t>("realtime_offset_ns", offsetof(Header, realtime_offset_ns), "ns");
  MERLIN_FIELD(t, Header, status_endpoint, "");
  MERLIN_FIELD(t, Header, command_endpoint, "");
}

// Begins the fields of a channel. Adds `count` and `wake` (the futex word), with which a reader
// waits for samples. The fields that are added to `t` afterwards are those of a sample; each refers
// to the ring of the last 256 samples.
template <typename T>
void startChannel(FieldTable& t, const std::string& name, std::size_t offset) {
  t.bare(name, offset);
  t.add<std::uint64_t>("count", Channel<T>::countOffset(), "");
  t.add<std::uint32_t>("wake", Channel<T>::wakeOffset(), "futex");
  t.slot(name, offset, offset + Channel<T>::ringOffset(), sizeof(SeqSlot<T>), kHistory);
}

void addMembers(FieldTable& t, std::type_identity<DeviceHealth>) {
  MERLIN_FIELD(t, DeviceHealth, since_ns, "ns");
  MERLIN_FIELD(t, DeviceHealth, updated_ns, "ns");
  MERLIN_FIELD(t, DeviceHealth, samples, "");
  MERLIN_FIELD(t, DeviceHealth, bad_bytes, "");
  MERLIN_FIELD(t, DeviceHealth, bad_packets, "");
  MERLIN_FIELD(t, DeviceHealth, state, "HealthState");
  MERLIN_FIELD(t, DeviceHealth, reconnects, "");
  MERLIN_FIELD(t, DeviceHealth, rate_hz, "Hz");
  MERLIN_FIELD(t, DeviceHealth, port, "");
  MERLIN_FIELD(t, DeviceHealth, identity, "");
  MERLIN_FIELD(t, DeviceHealth, reason, "");
}

void addMembers(FieldTable& t, std::type_identity<GloveSample>) {
  MERLIN_FIELD(t, GloveSample, received_ns, "ns");
  MERLIN_FIELD(t, GloveSample, counter, "");
  MERLIN_FIELD(t, GloveSample, flags, "bits");
  MERLIN_FIELD(t, GloveSample, angle_rad, "rad");
  MERLIN_FIELD(t, GloveSample, sensors, "");
  MERLIN_FIELD(t, GloveSample, raw, "");
}

void addMembers(FieldTable& t, std::type_identity<PostureSample>) {
  MERLIN_FIELD(t, PostureSample, received_ns, "ns");
  MERLIN_FIELD(t, PostureSample, since_ns, "ns");
  MERLIN_FIELD(t, PostureSample, counter, "");
  MERLIN_FIELD(t, PostureSample, code, "bits");
  MERLIN_FIELD(t, PostureSample, activation, "");
  MERLIN_FIELD(t, PostureSample, name, "");
}

void addMembers(FieldTable& t, std::type_identity<PostureState>) {
  MERLIN_FIELD(t, PostureState, received_ns, "ns");
  MERLIN_FIELD(t, PostureState, since_ns, "ns");
  MERLIN_FIELD(t, PostureState, counter, "");
  MERLIN_FIELD(t, PostureState, code, "bits");
  MERLIN_FIELD(t, PostureState, margin, "");
  MERLIN_FIELD(t, PostureState, entered, "");
  MERLIN_FIELD(t, PostureState, name, "");
  MERLIN_FIELD(t, PostureState, seen, "");
}

void addMembers(FieldTable& t, std::type_identity<TrackerSample>) {
  MERLIN_FIELD(t, TrackerSample, received_ns, "ns");
  MERLIN_FIELD(t, TrackerSample, counter, "");
  MERLIN_FIELD(t, TrackerSample, station, "");
  MERLIN_FIELD(t, TrackerSample, position_m, "m");
  MERLIN_FIELD(t, TrackerSample, orientation_wxyz, "");
  MERLIN_FIELD(t, TrackerSample, error, "");
  MERLIN_FIELD(t, TrackerSample, stylus, "");
}

void addMembers(FieldTable& t, std::type_identity<TrackerFrames>) {
  MERLIN_FIELD(t, TrackerFrames, alignment_cm, "4 x 9 cm");
  MERLIN_FIELD(t, TrackerFrames, boresight_wxyz, "4 x wxyz");
}

void addMembers(FieldTable& t, std::type_identity<BallSample>) {
  MERLIN_FIELD(t, BallSample, received_ns, "ns");
  MERLIN_FIELD(t, BallSample, counter, "");
  MERLIN_FIELD(t, BallSample, buttons, "bits");
  MERLIN_FIELD(t, BallSample, translation, "full scale");
  MERLIN_FIELD(t, BallSample, rotation, "full scale");
  MERLIN_FIELD(t, BallSample, raw, "");
  MERLIN_FIELD(t, BallSample, period_us, "us");
  MERLIN_FIELD(t, BallSample, keys, "linux key");
}

void addMembers(FieldTable& t, std::type_identity<TouchSample>) {
  MERLIN_FIELD(t, TouchSample, received_ns, "ns");
  MERLIN_FIELD(t, TouchSample, counter, "");
  MERLIN_FIELD(t, TouchSample, fingers, "");
  MERLIN_FIELD(t, TouchSample, id, "");
  MERLIN_FIELD(t, TouchSample, position, "10 x right, down");
  MERLIN_FIELD(t, TouchSample, aspect, "");
  MERLIN_FIELD(t, TouchSample, buttons, "bits");
  MERLIN_FIELD(t, TouchSample, wheel, "notches");
}

void addMembers(FieldTable& t, std::type_identity<HandSample>) {
  MERLIN_FIELD(t, HandSample, received_ns, "ns");
  MERLIN_FIELD(t, HandSample, glove_ns, "ns");
  MERLIN_FIELD(t, HandSample, counter, "");
  MERLIN_FIELD(t, HandSample, flags, "bits");
  MERLIN_FIELD(t, HandSample, joint_rad, "rad");
  MERLIN_FIELD(t, HandSample, position_m, "m");
  MERLIN_FIELD(t, HandSample, orientation_wxyz, "");
  MERLIN_FIELD(t, HandSample, velocity_m_s, "m/s");
  MERLIN_FIELD(t, HandSample, turn_rad_s, "rad/s");
  MERLIN_FIELD(t, HandSample, delay_s, "s");
}

void addMembers(FieldTable& t, std::type_identity<GestureState>) {
  MERLIN_FIELD(t, GestureState, received_ns, "ns");
  MERLIN_FIELD(t, GestureState, began_ns, "ns");
  MERLIN_FIELD(t, GestureState, counter, "");
  MERLIN_FIELD(t, GestureState, passed_over, "");
  MERLIN_FIELD(t, GestureState, certainty, "");
  MERLIN_FIELD(t, GestureState, name, "");
}

void addMembers(FieldTable& t, std::type_identity<GpioSample>) {
  MERLIN_FIELD(t, GpioSample, changed_ns, "ns");
  MERLIN_FIELD(t, GpioSample, counter, "");
  MERLIN_FIELD(t, GpioSample, power, "Power");
  MERLIN_FIELD(t, GpioSample, video, "");
  MERLIN_FIELD(t, GpioSample, lamp, "Lamp");
  MERLIN_FIELD(t, GpioSample, presses, "");
  MERLIN_FIELD(t, GpioSample, wait_s, "s");
}

// Adds the arrays as whole fields, and the state of each action as a field with the action's name:
// "actions.ball.reset_view.begun", and for an action that lasts as long as its input also one that
// ends with ".held".
void addMembers(FieldTable& t, std::type_identity<ActionState>) {
  MERLIN_FIELD(t, ActionState, changed_ns, "ns");
  MERLIN_FIELD(t, ActionState, generation, "");
  MERLIN_FIELD(t, ActionState, begun, "");
  MERLIN_FIELD(t, ActionState, held, "");
  MERLIN_FIELD(t, ActionState, sequence, "");
  MERLIN_FIELD(t, ActionState, recent, "");
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    t.add<std::uint32_t>(fmt::format("{}.begun", kActions[i]),
                         offsetof(ActionState, begun) + i * sizeof(std::uint32_t), "");
    if (isHeldAction(kActions[i]))
      t.add<std::uint8_t>(fmt::format("{}.held", kActions[i]), offsetof(ActionState, held) + i, "");
  }
}

template <typename T>
void addSlot(FieldTable& t, const std::string& name, std::size_t offset) {
  t.slot(name, offset);
  addMembers(t, std::type_identity<T>());
}

template <typename T>
void addChannel(FieldTable& t, const std::string& name, std::size_t offset) {
  startChannel<T>(t, name, offset);
  addMembers(t, std::type_identity<T>());
}

// Adds the first part of the members of WallStats; addPace() adds the rest.
void addWall(FieldTable& t) {
  t.slot("wall", offsetof(WallSegment, stats));
  MERLIN_FIELD(t, WallStats, updated_ns, "ns");
  MERLIN_FIELD(t, WallStats, frames, "");
  MERLIN_FIELD(t, WallStats, deadlines, "");
  MERLIN_FIELD(t, WallStats, late, "");
  MERLIN_FIELD(t, WallStats, cost, "");
  MERLIN_FIELD(t, WallStats, detail_step, "");
  MERLIN_FIELD(t, WallStats, detail_steps, "");
  MERLIN_FIELD(t, WallStats, moving, "");
  MERLIN_FIELD(t, WallStats, full_detail, "");
  MERLIN_FIELD(t, WallStats, longest_late, "");
  MERLIN_FIELD(t, WallStats, rate_asked_hz, "Hz");
  MERLIN_FIELD(t, WallStats, rate_held_hz, "Hz");
  MERLIN_FIELD(t, WallStats, late_share_1s, "");
  MERLIN_FIELD(t, WallStats, late_share_1min, "");
  MERLIN_FIELD(t, WallStats, late_share, "");
  MERLIN_FIELD(t, WallStats, work_ms, "ms");
  MERLIN_FIELD(t, WallStats, work_median_ms, "ms");
  MERLIN_FIELD(t, WallStats, utilisation, "");
  MERLIN_FIELD(t, WallStats, head_room, "");
}

// Adds the members of WallStats that addWall() leaves out, to the slot that addWall() began.
void addPace(FieldTable& t) {
  MERLIN_FIELD(t, WallStats, cost_fixed_ms, "ms");
  MERLIN_FIELD(t, WallStats, cost_coefficient_us, "us");
  MERLIN_FIELD(t, WallStats, input_age_ms, "ms");
  MERLIN_FIELD(t, WallStats, still_to_full_s, "s");
  MERLIN_FIELD(t, WallStats, resumed, "");
  MERLIN_FIELD(t, WallStats, resumed_late, "");
  MERLIN_FIELD(t, WallStats, grabbed, "");
  MERLIN_FIELD(t, WallStats, mode, "");
  MERLIN_FIELD(t, WallStats, posture, "");
  MERLIN_FIELD(t, WallStats, scale_divisor, "");
  MERLIN_FIELD(t, WallStats, rate_now_hz, "Hz");
  MERLIN_FIELD(t, WallStats, rate_divisor, "");
  MERLIN_FIELD(t, WallStats, operator_coarser, "");
  MERLIN_FIELD(t, WallStats, ladder_steps, "");
  MERLIN_FIELD(t, WallStats, budget, "");
  MERLIN_FIELD(t, WallStats, held_cost, "");
  MERLIN_FIELD(t, WallStats, cost_exponent, "");
  MERLIN_FIELD(t, WallStats, oscillation, "");
  MERLIN_FIELD(t, WallStats, settle_frames, "");
  MERLIN_FIELD(t, WallStats, still_to_first_s, "s");
  MERLIN_FIELD(t, WallStats, work_histogram, "1/16 period");
  MERLIN_FIELD(t, WallStats, returned, "");
  MERLIN_FIELD(t, WallStats, full_cost, "");
  MERLIN_FIELD(t, WallStats, cost_unit, "");
  MERLIN_FIELD(t, WallStats, least_cost, "");
}

void addTrace(FieldTable& t) {
  startChannel<FrameTrace>(t, "trace", offsetof(WallSegment, trace));
  MERLIN_FIELD(t, FrameTrace, begin_ns, "ns");
  MERLIN_FIELD(t, FrameTrace, end_ns, "ns");
  MERLIN_FIELD(t, FrameTrace, deadline_ns, "ns");
  MERLIN_FIELD(t, FrameTrace, period, "");
  MERLIN_FIELD(t, FrameTrace, cost, "");
  MERLIN_FIELD(t, FrameTrace, moving, "");
  MERLIN_FIELD(t, FrameTrace, late, "");
  t.add<std::uint32_t>("steps", offsetof(FrameTrace, count), "");  // "count" is the channel's
  const auto step = [&t]<typename Member>(Member TraceStep::*, const char* name, std::size_t at,
                                          const char* unit) {
    t.addOfEach<Member>(name, offsetof(FrameTrace, steps) + at, unit,
                        std::extent_v<decltype(FrameTrace::steps)>, sizeof(TraceStep));
  };
  step(&TraceStep::begin_ns, "step.begin_ns", offsetof(TraceStep, begin_ns), "ns");
  step(&TraceStep::length_ns, "step.length_ns", offsetof(TraceStep, length_ns), "ns");
  step(&TraceStep::kind, "step.kind", offsetof(TraceStep, kind), "StepKind");
  step(&TraceStep::tile, "step.tile", offsetof(TraceStep, tile), "");
}

void addInteraction(FieldTable& t) {
  t.slot("interaction", offsetof(WallSegment, interaction));
  MERLIN_FIELD(t, WallInteraction, updated_ns, "ns");
  MERLIN_FIELD(t, WallInteraction, pointing, "0 wall model");
  MERLIN_FIELD(t, WallInteraction, pixel, "px");
  MERLIN_FIELD(t, WallInteraction, at_model_m, "m");
  MERLIN_FIELD(t, WallInteraction, snapshots, "");
  MERLIN_FIELD(t, WallInteraction, content, "");
  MERLIN_FIELD(t, WallInteraction, shown, "0 blank frozen");
  MERLIN_FIELD(t, WallInteraction, playlist, "0 waits runs");
  MERLIN_FIELD(t, WallInteraction, light, "");
}

void addOutputs(FieldTable& t) {
  t.slot("outputs", offsetof(WallSegment, outputs));
  MERLIN_FIELD(t, WallOutputs, count, "");
  const auto each = [&t]<typename Member>(Member OutputStats::*, const char* name, std::size_t at,
                                          const char* unit) {
    t.addOfEach<Member>(name, offsetof(WallOutputs, outputs) + at, unit,
                        std::extent_v<decltype(WallOutputs::outputs)>, sizeof(OutputStats));
  };
  each(&OutputStats::name, "name", offsetof(OutputStats, name), "");
  each(&OutputStats::kind, "kind", offsetof(OutputStats, kind), "");
  each(&OutputStats::frames, "frames", offsetof(OutputStats, frames), "");
  each(&OutputStats::failed, "failed", offsetof(OutputStats, failed), "");
  each(&OutputStats::shown_hz, "shown_hz", offsetof(OutputStats, shown_hz), "Hz");
  each(&OutputStats::late_share, "late_share", offsetof(OutputStats, late_share), "");
  each(&OutputStats::fault, "fault", offsetof(OutputStats, fault), "");
  each(&OutputStats::picture, "picture", offsetof(OutputStats, picture), "0, 1 right, 2.. wrong");
  each(&OutputStats::picture_ms, "picture_ms", offsetof(OutputStats, picture_ms), "ms");
  each(&OutputStats::picture_fault, "picture_fault", offsetof(OutputStats, picture_fault), "");
}

void addContent(FieldTable& t) {
  t.slot("content", offsetof(WallSegment, content));
  MERLIN_FIELD(t, WallContent, updated_ns, "ns");
  MERLIN_FIELD(t, WallContent, name, "");
  MERLIN_FIELD(t, WallContent, kind, "");
  MERLIN_FIELD(t, WallContent, slide, "");
  MERLIN_FIELD(t, WallContent, finished, "");
  MERLIN_FIELD(t, WallContent, refused, "");
}

void addIdle(FieldTable& t) {
  t.slot("idle", offsetof(WallSegment, idle));
  MERLIN_FIELD(t, WallIdle, updated_ns, "ns");
  MERLIN_FIELD(t, WallIdle, playlist_in_s, "s");
  MERLIN_FIELD(t, WallIdle, next_in_s, "s");
  MERLIN_FIELD(t, WallIdle, dim_in_s, "s");
  MERLIN_FIELD(t, WallIdle, testcard, "");
}

void addPanel(FieldTable& t) {
  t.slot("panel", offsetof(WallSegment, panel));
  MERLIN_FIELD(t, WallPanel, updated_ns, "ns");
  MERLIN_FIELD(t, WallPanel, x, "px");
  MERLIN_FIELD(t, WallPanel, y, "px");
  MERLIN_FIELD(t, WallPanel, width, "px");
  MERLIN_FIELD(t, WallPanel, height, "px");
  MERLIN_FIELD(t, WallPanel, by_ball, "");
}

void addNotice(FieldTable& t) {
  t.slot("notice", offsetof(WallSegment, notice));
  MERLIN_FIELD(t, WallNotice, updated_ns, "ns");
  MERLIN_FIELD(t, WallNotice, text, "");
}

}  // namespace

template <typename T>
std::vector<Field> slotFields(const std::string& name, std::size_t offset) {
  FieldTable t;
  addSlot<T>(t, name, offset);
  return t.take();
}

template <typename T>
std::vector<Field> channelFields(const std::string& name, std::size_t offset) {
  FieldTable t;
  addChannel<T>(t, name, offset);
  return t.take();
}

template std::vector<Field> slotFields<DeviceHealth>(const std::string&, std::size_t);
template std::vector<Field> slotFields<PostureState>(const std::string&, std::size_t);
template std::vector<Field> slotFields<GestureState>(const std::string&, std::size_t);
template std::vector<Field> slotFields<TrackerFrames>(const std::string&, std::size_t);
template std::vector<Field> slotFields<ActionState>(const std::string&, std::size_t);
template std::vector<Field> channelFields<GloveSample>(const std::string&, std::size_t);
template std::vector<Field> channelFields<PostureSample>(const std::string&, std::size_t);
template std::vector<Field> channelFields<TrackerSample>(const std::string&, std::size_t);
template std::vector<Field> channelFields<BallSample>(const std::string&, std::size_t);
template std::vector<Field> channelFields<TouchSample>(const std::string&, std::size_t);
template std::vector<Field> channelFields<HandSample>(const std::string&, std::size_t);
template std::vector<Field> channelFields<GpioSample>(const std::string&, std::size_t);

namespace {

// `alias`: whether the slots of postures are also added as "posture" and "posture_state", without
// the glove's name.
void addGlove(FieldTable& t, const std::string& name, std::size_t offset, bool alias) {
  addChannel<GloveSample>(t, name, offset + offsetof(GloveSlots, samples));
  for (const std::string& prefix : {name + ".", std::string()}) {
    if (prefix.empty() && !alias) continue;
    addChannel<PostureSample>(t, prefix + "posture", offset + offsetof(GloveSlots, posture));
    addSlot<PostureState>(t, prefix + "posture_state",
                          offset + offsetof(GloveSlots, posture_state));
  }
}

void addTracker(FieldTable& t, const std::string& name, std::size_t offset) {
  for (std::size_t i = 0; i < kStations; ++i) {
    addChannel<TrackerSample>(
        t, fmt::format("{}{}", name, i + 1),
        offset + offsetof(TrackerSlots, stations) + i * sizeof(Channel<TrackerSample>));
  }
  addSlot<TrackerFrames>(t, name, offset + offsetof(TrackerSlots, frames));
}

void addHand(FieldTable& t, const std::string& name, std::size_t index) {
  addChannel<HandSample>(t, name,
                         offsetof(DevicesSegment, hand) + index * sizeof(Channel<HandSample>));
  addSlot<GestureState>(t, name + ".gesture",
                        offsetof(DevicesSegment, gesture) + index * sizeof(SeqSlot<GestureState>));
}

std::size_t actionsAt(std::size_t source) {
  return offsetof(DevicesSegment, actions) + source * sizeof(SeqSlot<ActionState>);
}

}  // namespace

std::vector<Field> devicesFields(const SlotNames& names) {
  FieldTable t;
  addHeader(t);
  for (std::size_t i = 0; i < names.devices.size(); ++i) {
    addSlot<DeviceHealth>(t, names.devices[i].name + ".health",
                          offsetof(DevicesSegment, health) + i * sizeof(SeqSlot<DeviceHealth>));
  }
  std::size_t gloves = 0, trackers = 0, balls = 0, touches = 0;
  for (const auto& [name, kind] : names.devices) {
    if (kind == SampleKind::kGlove) {
      addGlove(t, name, offsetof(DevicesSegment, glove) + gloves * sizeof(GloveSlots), gloves == 0);
      ++gloves;
    } else if (kind == SampleKind::kTracker) {
      addTracker(t, name, offsetof(DevicesSegment, tracker) + trackers++ * sizeof(TrackerSlots));
    } else if (kind == SampleKind::kBall) {
      addChannel<BallSample>(
          t, name, offsetof(DevicesSegment, ball) + balls++ * sizeof(Channel<BallSample>));
    } else {
      addChannel<TouchSample>(
          t, name, offsetof(DevicesSegment, touch) + touches++ * sizeof(Channel<TouchSample>));
    }
  }
  for (std::size_t i = 0; i < names.hands.size(); ++i) addHand(t, names.hands[i], i);
  addChannel<GpioSample>(t, "gpio", offsetof(DevicesSegment, gpio));
  addSlot<DeviceHealth>(t, "gpio.health", offsetof(DevicesSegment, gpio_health));
  for (std::size_t i = 0; i < names.devices.size(); ++i)
    addSlot<ActionState>(t, "actions." + names.devices[i].name, actionsAt(i));
  for (std::size_t i = 0; i < names.hands.size(); ++i)
    addSlot<ActionState>(t, "actions." + names.hands[i], actionsAt(kFirstHandSource + i));
  addSlot<ActionState>(t, "actions.panel", actionsAt(kPanelSource));
  return t.take();
}

std::vector<Field> wallFields() {
  FieldTable t;
  addHeader(t);
  addWall(t);
  addPace(t);
  addTrace(t);
  addInteraction(t);
  addOutputs(t);
  addContent(t);
  addIdle(t);
  addPanel(t);
  addNotice(t);
  t.bare("segment", 0);
  MERLIN_FIELD(t, WallSegment, framebuffer, "");
  return t.take();
}

}  // namespace merlin::shm
