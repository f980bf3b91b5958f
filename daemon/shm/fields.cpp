#include "daemon/shm/fields.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

namespace merlin::shm {
namespace {

template <typename T>
constexpr char kType = '?';
template <>
constexpr char kType<std::int64_t> = 'q';
template <>
constexpr char kType<std::uint64_t> = 'Q';
template <>
constexpr char kType<std::int32_t> = 'i';
template <>
constexpr char kType<std::uint32_t> = 'I';
template <>
constexpr char kType<HealthState> = 'I';
template <>
constexpr char kType<std::int16_t> = 'h';
template <>
constexpr char kType<std::uint8_t> = 'B';
template <>
constexpr char kType<float> = 'f';
template <>
constexpr char kType<char> = 's';

constexpr std::size_t kPayload = 8;  // of a SeqSlot: after its sequence

// Gathers the fields of slots, each at its place in the segment.
class Table {
 public:
  void slot(std::string prefix, std::size_t offset) {
    prefix_ = std::move(prefix);
    slot_ = offset;
  }

  template <typename Member>
  void add(std::string_view name, std::size_t offset_in_value, std::string_view unit) {
    using Element = std::remove_all_extents_t<Member>;
    static_assert(kType<Element> != '?');
    Field f{};
    const std::string full = prefix_ + "." + std::string(name);
    assert(full.size() < sizeof f.name && unit.size() < sizeof f.unit);
    std::copy(full.begin(), full.end(), f.name);
    std::copy(unit.begin(), unit.end(), f.unit);
    f.type[0] = kType<Element>;
    f.count = sizeof(Member) / sizeof(Element);  // NOLINT(bugprone-sizeof-expression)
    f.offset = static_cast<std::uint32_t>(slot_ + kPayload + offset_in_value);
    f.slot = static_cast<std::uint32_t>(slot_);
    fields_.push_back(f);
  }

  // Without a slot: one word, read and written whole.
  template <typename Element>
  void bare(const std::string& name, std::size_t offset, const std::string& unit) {
    Field f{};
    assert(name.size() < sizeof f.name && unit.size() < sizeof f.unit);
    std::copy(name.begin(), name.end(), f.name);
    std::copy(unit.begin(), unit.end(), f.unit);
    f.type[0] = kType<Element>;
    f.count = 1;
    f.offset = static_cast<std::uint32_t>(offset);
    fields_.push_back(f);
  }

  std::vector<Field> take() { return std::move(fields_); }

 private:
  std::string prefix_;
  std::size_t slot_ = 0;
  std::vector<Field> fields_;
};

#define MERLIN_FIELD(table, Sample, member, unit) \
  (table).add<decltype(Sample::member)>(#member, offsetof(Sample, member), unit)

void addHealth(Table& t, const char* device, std::size_t index) {
  t.slot(fmt::format("{}.health", device),
         offsetof(DevicesSegment, health) + index * sizeof(SeqSlot<DeviceHealth>));
  MERLIN_FIELD(t, DeviceHealth, state, "HealthState");
  MERLIN_FIELD(t, DeviceHealth, since_ns, "ns");
  MERLIN_FIELD(t, DeviceHealth, updated_ns, "ns");
  MERLIN_FIELD(t, DeviceHealth, samples, "");
  MERLIN_FIELD(t, DeviceHealth, bad_bytes, "");
  MERLIN_FIELD(t, DeviceHealth, rate_hz, "Hz");
  MERLIN_FIELD(t, DeviceHealth, reason, "");
}

// What a reader needs to wait for samples and to read those that it slept over: how many there
// were, the futex word, and the ring of the last 256 slots, whose stride its unit tells.
template <typename T>
void addChannel(Table& t, const char* name, std::size_t offset) {
  t.bare<std::uint64_t>(fmt::format("{}.count", name), offset + Channel<T>::countOffset(), "");
  t.bare<std::uint32_t>(fmt::format("{}.wake", name), offset + Channel<T>::wakeOffset(), "futex");
  t.bare<std::uint64_t>(fmt::format("{}.ring", name), offset + Channel<T>::ringOffset(),
                        fmt::format("{} x {} B", kHistory, sizeof(SeqSlot<T>)));
}

void addTracker(Table& t, std::size_t station) {
  t.slot(fmt::format("tracker{}", station + 1),
         offsetof(DevicesSegment, tracker) + station * sizeof(Channel<TrackerSample>));
  MERLIN_FIELD(t, TrackerSample, received_ns, "ns");
  MERLIN_FIELD(t, TrackerSample, counter, "");
  MERLIN_FIELD(t, TrackerSample, position_m, "m");
  MERLIN_FIELD(t, TrackerSample, orientation_wxyz, "");
  MERLIN_FIELD(t, TrackerSample, error, "");
}

// How the rate is kept.
void addPace(Table& t) {
  MERLIN_FIELD(t, WallStats, levels, "");
  MERLIN_FIELD(t, WallStats, cost_fixed_ms, "ms");
  MERLIN_FIELD(t, WallStats, cost_coefficient_us, "us");
  MERLIN_FIELD(t, WallStats, cost_exponent, "");
  MERLIN_FIELD(t, WallStats, rate_now_hz, "Hz");
  MERLIN_FIELD(t, WallStats, rate_divisor, "");
  MERLIN_FIELD(t, WallStats, operator_coarser, "");
  MERLIN_FIELD(t, WallStats, ladder_steps, "");
  MERLIN_FIELD(t, WallStats, budget, "");
  MERLIN_FIELD(t, WallStats, held_triangles, "");
  MERLIN_FIELD(t, WallStats, oscillation, "");
  MERLIN_FIELD(t, WallStats, settle_frames, "");
  MERLIN_FIELD(t, WallStats, still_to_first_s, "s");
  MERLIN_FIELD(t, WallStats, work_histogram, "1/16 period");
}

}  // namespace

std::vector<Field> devicesFields() {
  Table t;
  addHealth(t, "glove", kGlove);
  addHealth(t, "tracker", kTracker);
  addHealth(t, "ball", kBall);
  t.slot("glove", offsetof(DevicesSegment, glove));
  MERLIN_FIELD(t, GloveSample, received_ns, "ns");
  MERLIN_FIELD(t, GloveSample, counter, "");
  MERLIN_FIELD(t, GloveSample, flags, "bits");
  MERLIN_FIELD(t, GloveSample, angle_rad, "rad");
  MERLIN_FIELD(t, GloveSample, sensors, "");
  MERLIN_FIELD(t, GloveSample, raw, "");
  t.slot("posture", offsetof(DevicesSegment, posture));
  MERLIN_FIELD(t, PostureSample, received_ns, "ns");
  MERLIN_FIELD(t, PostureSample, since_ns, "ns");
  MERLIN_FIELD(t, PostureSample, counter, "");
  MERLIN_FIELD(t, PostureSample, code, "bits");
  MERLIN_FIELD(t, PostureSample, activation, "");
  MERLIN_FIELD(t, PostureSample, name, "");
  for (std::size_t station = 0; station < kStations; ++station) addTracker(t, station);
  t.slot("ball", offsetof(DevicesSegment, ball));
  MERLIN_FIELD(t, BallSample, received_ns, "ns");
  MERLIN_FIELD(t, BallSample, counter, "");
  MERLIN_FIELD(t, BallSample, buttons, "bits");
  MERLIN_FIELD(t, BallSample, translation, "full scale");
  MERLIN_FIELD(t, BallSample, rotation, "full scale");
  MERLIN_FIELD(t, BallSample, raw, "");
  t.slot("hand", offsetof(DevicesSegment, hand));
  MERLIN_FIELD(t, HandSample, received_ns, "ns");
  MERLIN_FIELD(t, HandSample, flags, "bits");
  MERLIN_FIELD(t, HandSample, joint_rad, "rad");
  MERLIN_FIELD(t, HandSample, position_m, "m");
  MERLIN_FIELD(t, HandSample, orientation_wxyz, "");
  MERLIN_FIELD(t, HandSample, velocity_m_s, "m/s");
  MERLIN_FIELD(t, HandSample, turn_rad_s, "rad/s");
  MERLIN_FIELD(t, HandSample, delay_s, "s");
  t.slot("gpio", offsetof(DevicesSegment, gpio));
  MERLIN_FIELD(t, GpioSample, power, "Power");
  MERLIN_FIELD(t, GpioSample, video, "");
  MERLIN_FIELD(t, GpioSample, lamp, "Lamp");
  MERLIN_FIELD(t, GpioSample, presses, "");
  MERLIN_FIELD(t, GpioSample, wait_s, "s");
  t.slot("gpio.health", offsetof(DevicesSegment, gpio_health));
  MERLIN_FIELD(t, DeviceHealth, state, "HealthState");
  MERLIN_FIELD(t, DeviceHealth, reason, "");
  addChannel<GloveSample>(t, "glove", offsetof(DevicesSegment, glove));
  addChannel<TrackerSample>(t, "tracker1", offsetof(DevicesSegment, tracker));
  addChannel<BallSample>(t, "ball", offsetof(DevicesSegment, ball));
  addChannel<HandSample>(t, "hand", offsetof(DevicesSegment, hand));
  t.slot("posture_state", offsetof(DevicesSegment, posture_state));
  MERLIN_FIELD(t, PostureState, received_ns, "ns");
  MERLIN_FIELD(t, PostureState, since_ns, "ns");
  MERLIN_FIELD(t, PostureState, code, "bits");
  MERLIN_FIELD(t, PostureState, margin, "");
  MERLIN_FIELD(t, PostureState, entered, "");
  MERLIN_FIELD(t, PostureState, name, "");
  MERLIN_FIELD(t, PostureState, seen, "");
  t.slot("tracker", offsetof(DevicesSegment, tracker_frames));
  MERLIN_FIELD(t, TrackerFrames, alignment_cm, "4 x 9 cm");
  MERLIN_FIELD(t, TrackerFrames, boresight_wxyz, "4 x wxyz");
  return t.take();
}

std::vector<Field> wallFields() {
  Table t;
  t.slot("wall", offsetof(WallSegment, stats));
  MERLIN_FIELD(t, WallStats, updated_ns, "ns");
  MERLIN_FIELD(t, WallStats, frames, "");
  MERLIN_FIELD(t, WallStats, deadlines, "");
  MERLIN_FIELD(t, WallStats, late, "");
  MERLIN_FIELD(t, WallStats, triangles, "");
  MERLIN_FIELD(t, WallStats, level, "");
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
  MERLIN_FIELD(t, WallStats, input_age_ms, "ms");
  MERLIN_FIELD(t, WallStats, still_to_full_s, "s");
  MERLIN_FIELD(t, WallStats, resumed, "");
  MERLIN_FIELD(t, WallStats, resumed_late, "");
  MERLIN_FIELD(t, WallStats, mode, "");
  MERLIN_FIELD(t, WallStats, posture, "");
  MERLIN_FIELD(t, WallStats, scale_divisor, "");
  addPace(t);
  addChannel<FrameTrace>(t, "trace", offsetof(WallSegment, trace));
  t.slot("interaction", offsetof(WallSegment, interaction));
  MERLIN_FIELD(t, WallInteraction, pointing, "0 wall model");
  MERLIN_FIELD(t, WallInteraction, pixel, "px");
  MERLIN_FIELD(t, WallInteraction, at_model_m, "m");
  MERLIN_FIELD(t, WallInteraction, snapshots, "");
  MERLIN_FIELD(t, WallInteraction, lamps, "");
  MERLIN_FIELD(t, WallInteraction, lamp, "Lamp");
  MERLIN_FIELD(t, WallInteraction, content, "");
  return t.take();
}

void setFields(Header& header, const std::vector<Field>& fields) {
  assert(fields.size() <= kMostFields);
  std::copy(fields.begin(), fields.end(), header.fields);
  header.field_count = static_cast<std::uint32_t>(fields.size());
}

}  // namespace merlin::shm
