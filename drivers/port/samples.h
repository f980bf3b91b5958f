// Samples: the measurements that drivers write and the rest of MERLIN reads.
//
// Each struct has fields of fixed width in SI units, has no pointers and is trivially copyable,
// because client processes map it as it is. Its size is asserted; a change requires a new
// shm::kVersion. `received_ns` is CLOCK_MONOTONIC at the arrival of the record's first byte;
// `counter` increases by one per record, so that a gap shows that records were lost.
#pragma once

#include <cstddef>
#include <cstdint>

namespace merlin {

// What a device measures.
enum class SampleKind { kGlove, kTracker, kBall, kTouch };

// Maximum numbers of a daemon's devices, in all and of each kind, and of its hands.
inline constexpr std::size_t kMostDevices = 16, kMostGloves = 4, kMostTrackers = 4, kMostBalls = 6,
                             kMostTouches = 2;
inline constexpr std::size_t kMostHands = 4;

// Slots of a CyberGlove, in the order of the interface unit's mask bits: 0 thumb roll ... 22 wrist
// yaw. drivers/cyberglove/README.md lists the slots and the rules that fill slot 7.
inline constexpr std::size_t kGloveSlots = 23;

struct GloveSample {
  enum Flag : std::uint32_t { kPlugged = 1, kWristSwitch = 2, kLight = 4 };

  std::int64_t received_ns;
  std::uint32_t counter;
  std::uint32_t flags;           // Flag bits, as on the wire
  float angle_rad[kGloveSlots];  // flexion positive; see the calibration for each slot's zero
  std::uint32_t sensors;         // number of measured slots (18 or 22); the others are computed
  std::uint8_t raw[24];          // 1..255 as on the wire, 0 where not measured; [23] unused
};
static_assert(sizeof(GloveSample) == 136 && offsetof(GloveSample, angle_rad) == 16);

// Stations of a Fastrak.
inline constexpr std::size_t kStations = 4;

struct TrackerSample {
  std::int64_t received_ns;
  std::uint32_t counter;
  std::uint32_t station;  // 1..4, as numbered on the unit
  // Pose in the station's frame (TrackerFrames); by default the transmitter's: x away from the
  // cable, y right, z down. The orientation is the unit quaternion q_frame_receiver.
  float position_m[3];
  float orientation_wxyz[4];
  char error;           // letter of the unit's built-in test; ' ': no error
  std::uint8_t stylus;  // 1 while the stylus's button is pressed
  std::uint8_t reserved[2];
};
static_assert(sizeof(TrackerSample) == 48 && offsetof(TrackerSample, position_m) == 16);

// For each station the frame in which its samples are given, as set in FastrakSettings; programs
// use it to convert samples back to the transmitter's frame.
struct TrackerFrames {
  float alignment_cm[kStations][9];    // the origin, a point on the x axis, one on the y axis
  float boresight_wxyz[kStations][4];  // orientation in that frame that counts as straight ahead
};
static_assert(sizeof(TrackerFrames) == 208);

// kKeys: maximum number of keys in a sample. kKeyNumbers: the kernel's numbers of keys are below
// it.
inline constexpr std::size_t kKeys = 8, kKeyNumbers = 0x300;

struct BallSample {
  std::int64_t received_ns;
  std::uint32_t counter;
  std::uint32_t buttons;    // bit 0 = button 1 ... bit 11 = button 12; a 2003's pick: button 9
  float translation[3];     // share of full scale, -1..1; x right, y up, z towards the person
  float rotation[3];        // about the same axes, right-handed, share of full scale
  std::int16_t raw[6];      // as on the wire: X Y Z A B C
  std::uint32_t period_us;  // since the last displacement packet, by the device's clock
  // For an input device of the kernel, the kernel's numbers of the keys and buttons that are
  // pressed, in ascending order; 0 in the rest.
  std::uint16_t keys[kKeys];
};
static_assert(sizeof(BallSample) == 72 && offsetof(BallSample, translation) == 16);

// The kernel's number of the first button of a mouse, BTN_LEFT.
inline constexpr std::uint16_t kFirstMouseButton = 0x110;

// Maximum number of fingers in a sample.
inline constexpr std::size_t kFingers = 10;

// The fingers on a touch frame or a screen, or the buttons and the wheel of a mouse. Published when
// a finger comes, moves or goes, and when a button or the wheel changes.
struct TouchSample {
  std::int64_t received_ns;
  std::uint32_t counter;
  // Number of fingers that touch now: entries used in the arrays below.
  std::uint32_t fingers;
  std::uint32_t id[kFingers];   // of each finger, constant while it stays down
  float position[kFingers][2];  // right and down, shares of width and height: 0..1
  float aspect;                 // the surface's width divided by its height
  std::uint16_t buttons;        // pressed: bit i is the kernel's number kFirstMouseButton + i
  std::uint16_t wheel;          // notches turned away from the person, modulo 65536
};
static_assert(sizeof(TouchSample) == 144 && offsetof(TouchSample, position) == 56);

struct PostureSample {
  std::int64_t received_ns;  // of the glove record in which the posture was recognised
  std::int64_t since_ns;     // received_ns of the first of the consecutive records with this code
  std::uint32_t counter;     // of the same glove record as received_ns
  std::uint32_t code;        // five bits: output i above 0.5 sets bit i
  float activation[5];       // the network's outputs
  char name[20];             // of the posture, NUL-ended; empty if the code has no name
};
static_assert(sizeof(PostureSample) == 64 && offsetof(PostureSample, activation) == 24);

// The current posture. A posture becomes current when it was held for a minimum time, and stays
// current until it has been absent for a minimum time; both are configured. A PostureSample is the
// result of a single record.
struct PostureState {
  std::int64_t received_ns;  // of the newest glove record
  std::int64_t since_ns;     // received_ns of the record with which the posture (or none) began
  std::uint32_t counter;     // of the newest glove record
  std::uint32_t code;        // of the current posture; 0 if there is none
  float margin;              // of the newest record: the least |2 y - 1| over the outputs y, 0..1
  std::uint32_t entered;     // number of postures that became current since the daemon started
  char name[20];             // of the current posture, NUL-ended; empty: none
  char seen[20];             // name of the posture in the newest record alone
};
static_assert(sizeof(PostureState) == 72 && offsetof(PostureState, name) == 32);

// The last gesture of a hand, and how many it has made since the daemon started.
struct GestureState {
  std::int64_t received_ns;   // of the tracker record with which the gesture ended; 0: none so far
  std::int64_t began_ns;      // received_ns of the record with which it began
  std::uint32_t counter;      // number of gestures
  std::uint32_t passed_over;  // gestures ignored because the hand held the model
  float certainty;            // 0..1: 1 is a gesture like the mean of those that were trained
  char name[36];              // of the gesture, NUL-ended; empty: none so far
};
static_assert(sizeof(GestureState) == 64 && offsetof(GestureState, name) == 28);

// The hand, from glove and tracker: joint angles and pose.
struct HandSample {
  enum Flag : std::uint32_t { kJoints = 1 };  // the joints are less than half a second old

  std::int64_t received_ns;  // of the tracker record
  std::int64_t glove_ns;     // received_ns of the glove record with the joints; 0: none so far
  std::uint32_t counter;     // of the tracker record
  std::uint32_t flags;       // Flag bits
  float joint_rad[kGloveSlots];
  float position_m[3];        // in the station's frame (TrackerFrames), smoothed
  float orientation_wxyz[4];  // smoothed
  float velocity_m_s[3];      // position at time t: position + velocity * (t - received)
  float turn_rad_s[3];        // angular velocity about the frame's axes
  float delay_s;              // delay of the smoothing at this moment
  std::uint32_t reserved;
};
static_assert(sizeof(HandSample) == 176 && offsetof(HandSample, position_m) == 116);

// State of the control panel: projectors, video switch, lamp, button.
struct GpioSample {
  enum Power : std::uint32_t { kOff = 0, kWarming = 1, kOn = 2, kCooling = 3 };
  enum Lamp : std::uint32_t { kLampOff = 0, kLampSlow = 1, kLampFast = 2, kLampOn = 3 };

  std::int64_t changed_ns;
  std::uint32_t counter;  // number of changes
  std::uint32_t power;    // of the projectors: a Power
  std::uint32_t video;    // 0: A, 1: B
  std::uint32_t lamp;     // a Lamp
  std::uint32_t presses;  // of the button, since the daemon started
  float wait_s;           // time until the projectors may be switched again; 0: now
};
static_assert(sizeof(GpioSample) == 32);

// State of a device's connection.
enum class HealthState : std::uint32_t {
  kAbsent = 0,   // no port is configured, or it cannot be opened, or it was closed
  kOpening = 1,  // the port is open; the set-up dialogue is in progress
  kOk = 2,       // streaming
  kFailed = 3,   // the port can be opened, but no device answers, or not as this device does
};

struct DeviceHealth {
  std::int64_t since_ns;      // when `state` began
  std::int64_t updated_ns;    // when this was written; if it is old, the daemon has stopped
  std::uint64_t samples;      // published since the daemon started
  std::uint64_t bad_bytes;    // dropped by the parser since the daemon started
  std::uint64_t bad_packets;  // packets dropped by the parser since the daemon started
  HealthState state;
  std::uint32_t reconnects;  // number of times that the device was lost after it had streamed
  float rate_hz;             // samples a second, over about the last second
  std::uint32_t reserved;
  char port[64];      // address of its port, NUL-ended, truncated if longer
  char identity[64];  // as the driver read it from the device ("Spaceball 2003, firmware 2.43")
  char reason[128];   // fault of the device or its line; empty: none
};
static_assert(sizeof(DeviceHealth) == 312 && offsetof(DeviceHealth, port) == 56);

}  // namespace merlin
