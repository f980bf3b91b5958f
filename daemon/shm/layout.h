// The shared-memory contract of MERLIN: what a client process maps. Clients: read this file first.
//
// Two segments, read-only for clients: /merlin-devices (what the devices measure) and /merlin-wall
// (how the wall fares). Each starts with a Header and carries a table of all its fields, the
// header's own included, so that readers in C, C++ and Python need no header file: README.md beside
// this file shows one of each. The frame buffer, /merlin-framebuffer, has the same kind of table
// (render/out/shared_frame_layout.h).
//
// One writer a slot, named here. No pointers, no locks; a field's meaning never changes. Fields are
// only ever appended; any change of an offset bumps kVersion, and a client refuses a version that
// it does not know. The table lies last and may move: its offset stands in the header.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "daemon/base/field_table.h"
#include "daemon/shm/channel.h"
#include "daemon/shm/seq_slot.h"
#include "drivers/port/samples.h"

namespace merlin::shm {

inline constexpr std::uint32_t kMagic = 0x4E4C524D;  // "MRLN" in memory
inline constexpr std::uint32_t kVersion = 2;
inline constexpr std::size_t kMostFields = 512;

// The first 40 bytes are all that a reader needs to know beforehand: they say where the table of
// fields is, and the table describes all else. They are the same in the frame buffer's segment.
struct Header {
  std::uint32_t magic, version;
  std::uint64_t size;          // of the whole segment [bytes]
  std::uint64_t generation;    // new at each start of the daemon: re-open when it changes
  std::uint32_t field_offset;  // of the table, from the segment's start [bytes]
  std::uint32_t field_count;
  std::uint32_t field_size;  // of one entry [bytes]; more than sizeof(Field) in a later version
  std::uint32_t pid;
  std::atomic<std::int64_t> heartbeat_ns;  // CLOCK_MONOTONIC, ten times a second; old: it is gone
  std::int64_t started_ns;                 // CLOCK_MONOTONIC
  // CLOCK_REALTIME minus CLOCK_MONOTONIC, measured anew with each heartbeat: add it to any stamp
  // for the UTC time in nanoseconds since 1970. It jumps when the system's clock is set.
  std::atomic<std::int64_t> realtime_offset_ns;
  char status_endpoint[108];   // ZeroMQ PUB: one JSON document a topic
  char command_endpoint[108];  // ZeroMQ REP: commands
};
static_assert(offsetof(Header, field_offset) == 24 && offsetof(Header, heartbeat_ns) == 40);
static_assert(offsetof(Header, status_endpoint) == 64 && sizeof(Header) == 280);

// Health of the three devices, by this number.
enum DeviceIndex : std::size_t { kGlove = 0, kTracker = 1, kBall = 2, kDevices = 3 };

struct DevicesSegment {
  Header header;
  alignas(64) SeqSlot<DeviceHealth> health[kDevices];  // writer: each device's own thread
  Channel<GloveSample> glove;                          // writer: the glove's device thread
  Channel<PostureSample> posture;                      // writer: the same, before the glove
  Channel<TrackerSample> tracker[kStations];           // writer: the tracker's; index: station - 1
  Channel<BallSample> ball;                            // writer: the ball's device thread
  Channel<HandSample> hand;                            // writer: the tracker's device thread
  Channel<GpioSample> gpio;                            // writer: the panel's thread
  alignas(64) SeqSlot<DeviceHealth> gpio_health;       // writer: the panel's thread
  alignas(64) SeqSlot<PostureState> posture_state;     // writer: the glove's device thread
  alignas(64) SeqSlot<TrackerFrames> tracker_frames;   // writer: the daemon, as it starts
  alignas(64) Field fields[kMostFields];               // writer: the daemon, as it starts
};

// How the wall fares; written once a frame by the wall's thread. Shares are 0..1.
struct WallStats {
  std::int64_t updated_ns;
  std::uint64_t frames;        // drawn and presented since the start
  std::uint64_t deadlines;     // passed while something moved, since the start
  std::uint64_t late;          // of these, missed
  std::uint32_t triangles;     // of the model, in the last frame
  std::uint32_t level;         // of the dendrogram: collapses done
  std::uint32_t levels;        // of the dendrogram, all
  std::uint32_t moving;        // 1 while something moves
  std::uint32_t full_detail;   // 1 while nothing is left out
  std::uint32_t longest_late;  // frames late in a row, at most, since the start
  float rate_asked_hz;
  float rate_held_hz;  // deadlines met over the last second; an unchanged picture meets its
  float late_share_1s, late_share_1min, late_share;
  float work_ms;         // of the last frame, from its begin to its last pixel
  float work_median_ms;  // of the last second's frames
  float utilisation;     // work / period, of the last second's moving frames
  float head_room;       // the governor's, share of the period
  float cost_fixed_ms;   // its model: work = fixed + coefficient * triangles^0.65
  float cost_coefficient_us;
  float input_age_ms;              // of the newest sample, when the last frame began
  float still_to_full_s;           // last time: from standstill to full detail
  std::uint32_t resumed;           // times that motion resumed after a standstill, since the start
  std::uint32_t resumed_late;      // of these: the first frame missed its deadline
  std::uint32_t grabbed;           // 1 while a hand holds the model
  char mode[16];                   // of the ball: "object" or "fly"
  char posture[20];                // the newest, empty for none
  std::uint32_t scale_divisor;     // 1, or 2: while it moves, tiles are drawn at half their size
  float rate_now_hz;               // the rate asked, divided by what the ladder gave way
  std::uint32_t rate_divisor;      // 1, or 2, 4: not even the fewest triangles came in time
  std::uint32_t operator_coarser;  // 1 while the operator's view is coarser, for want of time
  std::uint32_t ladder_steps;      // of the two above, up and down, since the start
  std::uint32_t budget;            // triangles for the next moving frame
  std::uint32_t held_triangles;    // the same, set by hand; 0: the governor's
  float cost_exponent;             // of the model, where the field above says 0.65
  float oscillation;               // (p95 - p5) / mean of the last 100 moving frames' triangles
  std::uint32_t settle_frames;     // last time: late in a row until five in a row were in time
  float still_to_first_s;          // last time: from standstill to the first finer picture
  std::uint32_t work_histogram[32];  // moving frames by work / period, since the start: buckets of
                                     // 1/16; the last holds all that is longer
  std::uint32_t returned;  // times that the start view came back by itself, since the start
  std::uint32_t reserved;
};
static_assert(sizeof(WallStats) == 336 && offsetof(WallStats, triangles) == 32);
static_assert(offsetof(WallStats, rate_now_hz) == 160 && offsetof(WallStats, scale_divisor) == 156);

// What a step of a frame does, by this number; merlin trace has their names.
enum class StepKind : std::uint16_t {
  kInput = 0,     // one read of every device's slot
  kScene = 1,     // input to camera, objects, content
  kGovernor = 2,  // triangles for this frame
  kCut = 3,       // of the dendrogram
  kUpload = 4,    // of the cut
  kDraw = 5,      // one tile: clearing and triangles
  kReadBack = 6,  // one tile's pixels
  kPresent = 7,   // to every sink
  kRefine = 8     // a slice of a finer picture, while nothing moves
};

struct TraceStep {
  std::uint32_t begin_ns;  // after the frame's begin
  std::uint32_t length_ns;
  StepKind kind;
  std::uint16_t tile;  // of the plan, from 0; of kDraw, kReadBack, kRefine
};

// One frame, or one period while nothing moves: where its time went.
struct FrameTrace {
  std::int64_t begin_ns, end_ns, deadline_ns;  // CLOCK_MONOTONIC
  std::uint64_t period;                        // number, since the start
  std::uint32_t triangles;
  std::uint32_t moving, late;
  std::uint32_t count;  // of steps; those beyond the last are not kept
  TraceStep steps[32];
};
static_assert(sizeof(TraceStep) == 12 && sizeof(FrameTrace) == 48 + 32 * 12);

// What people ask of the wall: pointing, snapshots, lamps, contents. Written once a period.
struct WallInteraction {
  enum Pointing : std::uint32_t { kNone = 0, kAtWall = 1, kAtModel = 2 };

  std::int64_t updated_ns;
  std::uint32_t pointing;
  std::int32_t pixel[2];  // of the frame, from its upper left corner; -1, -1: no wall tile shows it
  float at_model_m[3];    // where its ray ends, in the model's metres; on its bounding sphere
  std::uint32_t snapshots;  // of the frame, asked for since the start
  std::uint32_t lamps;      // times that a lamp was asked for, since the start
  std::uint32_t lamp;       // the last of them: GpioSample::Lamp
  std::uint32_t content;    // that is shown: 0 the model, 1 .. the configuration's contents
};
static_assert(sizeof(WallInteraction) == 48 && offsetof(WallInteraction, snapshots) == 32);

// One output of the wall, and how it fares.
struct OutputStats {
  char name[24];         // of the configuration
  char kind[24];         // "shared_memory", "png"
  std::uint64_t frames;  // shown since the start
  std::uint32_t failed;  // 1 while it cannot show frames
  float shown_hz;        // frames shown in the last second
  float late_share;      // of its frames while something moved, since the start: shown too late
  char fault[140];       // why it failed; empty while it works
};
static_assert(sizeof(OutputStats) == 208);

// Written once a period.
struct WallOutputs {
  std::uint32_t count;  // of outputs that are used
  std::uint32_t reserved;
  OutputStats outputs[8];
};

struct WallSegment {
  Header header;
  alignas(64) SeqSlot<WallStats> stats;  // writer: the wall's thread
  Channel<FrameTrace> trace;             // writer: the wall's thread; the last 256 periods
  alignas(64) SeqSlot<WallInteraction> interaction;  // writer: the wall's thread
  // The name of the frame buffer's segment, "/merlin-framebuffer"; empty until it is there.
  alignas(64) char framebuffer[64];
  alignas(64) SeqSlot<WallOutputs> outputs;  // writer: the wall's thread
  alignas(64) Field fields[kMostFields];     // writer: the daemon, as it starts
};

}  // namespace merlin::shm
