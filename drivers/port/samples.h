// Samples: the measurements that drivers write and the rest of MERLIN reads.
//
// Each struct is fixed-width, SI, pointer-free and trivially copyable, because it is mapped as it
// stands by client processes. Its size is asserted; changing one bumps shm::kVersion.
// `received_ns` is CLOCK_MONOTONIC at the record's first byte; `counter` grows by one a record, so
// that a gap is a lost record.
#pragma once

#include <cstddef>
#include <cstdint>

namespace merlin {

// Slots of a CyberGlove, in the order of the interface unit's mask bits: 0 thumb roll ... 22 wrist
// yaw. What each slot is, and which rule fills slot 7: drivers/cyberglove/README.md.
inline constexpr std::size_t kGloveSlots = 23;

struct GloveSample {
  enum Flag : std::uint32_t { kPlugged = 1, kWristSwitch = 2, kLight = 4 };

  std::int64_t received_ns;
  std::uint32_t counter;
  std::uint32_t flags;           // Flag bits, as on the wire
  float angle_rad[kGloveSlots];  // flexion positive; see the calibration for each slot's zero
  std::uint32_t sensors;         // how many slots were measured (18 or 22); others were filled
  std::uint8_t raw[24];          // 1..255 as on the wire, 0 where not measured; [23] unused
};
static_assert(sizeof(GloveSample) == 136 && offsetof(GloveSample, angle_rad) == 16);

// Stations of a Fastrak.
inline constexpr std::size_t kStations = 4;

struct TrackerSample {
  std::int64_t received_ns;
  std::uint32_t counter;
  std::uint32_t station;      // 1..4, as the switches on the unit name them
  float position_m[3];        // transmitter frame: x away from the cable, y right, z down
  float orientation_wxyz[4];  // unit quaternion q_transmitter_receiver
  char error;                 // ' ' for none, else the unit's built-in-test letter
  std::uint8_t stylus;        // 1 while the stylus's button is pressed
  std::uint8_t reserved[2];
};
static_assert(sizeof(TrackerSample) == 48 && offsetof(TrackerSample, position_m) == 16);

// Frames in which the tracker's samples are given, for each station, as in FastrakSettings; for
// programs that want them in the transmitter's frame.
struct TrackerFrames {
  float alignment_cm[kStations][9];  // a point of the origin, one on the x axis, one on the y axis
  float boresight_wxyz[kStations][4];  // counts as straight ahead, in that frame
};
static_assert(sizeof(TrackerFrames) == 208);

struct BallSample {
  std::int64_t received_ns;
  std::uint32_t counter;
  std::uint32_t buttons;    // bit 0 = button 1 ... bit 11 = button 12; the pick button is the last
  float translation[3];     // share of full scale, -1..1; x right, y up, z towards the person
  float rotation[3];        // about the same axes, right-handed, share of full scale
  std::int16_t raw[6];      // as on the wire: X Y Z A B C
  std::uint32_t period_us;  // the device's own time since its last displacement packet
};
static_assert(sizeof(BallSample) == 56 && offsetof(BallSample, translation) == 16);

struct PostureSample {
  std::int64_t received_ns;  // of the glove record that it was recognised from
  std::int64_t since_ns;     // received_ns of the first record in a row with this code
  std::uint32_t counter;     // of that glove record
  std::uint32_t code;        // five bits: output i above 0.5 sets bit i
  float activation[5];       // the network's outputs
  char name[20];             // of the code, NUL-ended; empty where the code has no name
};
static_assert(sizeof(PostureSample) == 64 && offsetof(PostureSample, activation) == 24);

// The posture that a person means: held and left with hysteresis, as the configuration says.
// PostureSample is what one record shows.
struct PostureState {
  std::int64_t received_ns;  // of the glove record that it was last judged by
  std::int64_t since_ns;     // received_ns of the first record that showed it, or no longer did
  std::uint32_t counter;     // of that last record
  std::uint32_t code;        // of the posture that is held; 0 where none is
  float margin;              // of that last record: the least |2 y - 1| over the outputs, 0..1
  std::uint32_t entered;     // postures that have begun to be held since the daemon started
  char name[20];             // that is held, NUL-ended; empty for none
  char seen[20];             // in that last record alone
};
static_assert(sizeof(PostureState) == 72 && offsetof(PostureState, name) == 32);

// Glove and tracker as one hand: the joints' angles and where the hand is.
struct HandSample {
  enum Flag : std::uint32_t { kJoints = 1 };  // a glove's record of the last half second is in it

  std::int64_t received_ns;  // of the tracker's record
  std::int64_t glove_ns;     // of the glove's record that the joints come from; 0 for none
  std::uint32_t counter;     // of that tracker's record
  std::uint32_t flags;       // Flag bits
  float joint_rad[kGloveSlots];
  float position_m[3];        // transmitter's frame, smoothed
  float orientation_wxyz[4];  // smoothed
  float velocity_m_s[3];      // for a pose at another time: position + velocity * (t - received)
  float turn_rad_s[3];        // about the transmitter's axes
  float delay_s;              // that smoothing adds at this moment
  std::uint32_t reserved;
};
static_assert(sizeof(HandSample) == 176 && offsetof(HandSample, position_m) == 116);

// The lines of the panel: projectors, video switch, lamp, button.
struct GpioSample {
  enum Power : std::uint32_t { kOff = 0, kWarming = 1, kOn = 2, kCooling = 3 };
  enum Lamp : std::uint32_t { kLampOff = 0, kLampSlow = 1, kLampFast = 2, kLampOn = 3 };

  std::int64_t changed_ns;
  std::uint32_t counter;  // of changes
  std::uint32_t power;    // of the projectors
  std::uint32_t video;    // 0: A, 1: B
  std::uint32_t lamp;
  std::uint32_t presses;  // of the button, since the daemon started
  float wait_s;           // until the projectors may be switched again; 0: now
};
static_assert(sizeof(GpioSample) == 32);

// How a device is.
enum class HealthState : std::uint32_t {
  kAbsent = 0,   // its port cannot be opened
  kOpening = 1,  // the dialogue is under way
  kOk = 2,       // streaming
  kFailed = 3,   // the port is open, and what answers there is not this device, or nothing is
};

struct DeviceHealth {
  std::int64_t since_ns;      // when `state` began
  std::int64_t updated_ns;    // when this was written; old means that the daemon is gone
  std::uint64_t samples;      // published since the daemon started
  std::uint64_t bad_bytes;    // dropped by the parser since the daemon started
  std::uint64_t bad_packets;  // packets dropped whole
  HealthState state;
  std::uint32_t reconnects;  // times that it was lost after it had streamed
  float rate_hz;             // samples a second, over about the last second
  std::uint32_t reserved;
  char port[64];      // where it is looked for, NUL-ended, cut if longer
  char identity[64];  // what it said it is
  char reason[128];   // why it is not well; empty where it is
};
static_assert(sizeof(DeviceHealth) == 312 && offsetof(DeviceHealth, port) == 56);

}  // namespace merlin
