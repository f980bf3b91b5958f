// The layout of MERLIN's shared memory, which client processes map. Clients: read this file first.
//
// Two segments, read-only for clients: /merlin-devices (the devices' samples) and /merlin-wall (the
// wall's statistics). Each starts with a Header and contains a table of all its fields, including
// the header's, so that readers in C, C++ and Python need no header file; README.md in this folder
// names an example of each. The frame buffer, /merlin-framebuffer, has the same kind of table
// (render/out/shared_frame_layout.h).
//
// Each slot has one writer, named here. No pointers, no locks; a field's meaning never changes. New
// fields are only appended; any change of an offset increments kVersion, and a client must refuse a
// version that it does not know. The table is last and may move: the header has its offset.
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
inline constexpr std::uint32_t kVersion = 6;
inline constexpr std::size_t kMostFields = 704;          // of the wall's segment
inline constexpr std::size_t kMostDevicesFields = 2304;  // of the devices' segment

// A reader only needs to know the first 40 bytes beforehand: they contain the offset of the table
// of fields, which describes everything else. They are the same in the frame buffer's segment.
struct Header {
  std::uint32_t magic, version;
  std::uint64_t size;          // size of the whole segment [bytes]
  std::uint64_t generation;    // changes at each start of the daemon: then open the segment again
  std::uint32_t field_offset;  // offset of the table from the segment's start [bytes]
  std::uint32_t field_count;   // number of its entries
  std::uint32_t
      field_size;  // size of an entry [bytes]; may exceed sizeof(Field) in a later version
  std::uint32_t pid;
  std::atomic<std::int64_t> heartbeat_ns;  // CLOCK_MONOTONIC, set ten times a second
  std::int64_t started_ns;                 // CLOCK_MONOTONIC
  // CLOCK_REALTIME minus CLOCK_MONOTONIC, measured with each heartbeat: add it to a time stamp to
  // get UTC in nanoseconds since 1970. It jumps when the system's clock is set.
  std::atomic<std::int64_t> realtime_offset_ns;
  char status_endpoint[108];   // ZeroMQ PUB: JSON documents by topic
  char command_endpoint[108];  // ZeroMQ REP: commands
};
static_assert(offsetof(Header, field_offset) == 24 && offsetof(Header, heartbeat_ns) == 40);
static_assert(offsetof(Header, status_endpoint) == 64 && sizeof(Header) == 280);

// Maximum number of actions (daemon/base/commands.h).
inline constexpr std::size_t kMostActions = 64;

// State of the actions that the inputs of one source (device, panel or hand) are bound to. Written
// when one begins or ends. The arrays are indexed like kActions in daemon/base/commands.h; other
// processes find an action by its field's name.
struct ActionState {
  std::int64_t changed_ns;   // time of the input that last changed this; 0: none yet
  std::uint64_t generation;  // of the daemon that counts; when it changes, the counts start anew
  std::uint32_t begun[kMostActions];  // times that the action has begun
  std::uint8_t held[kMostActions];    // 1 while an action is held that lasts as long as its input
  std::uint32_t sequence;             // number of actions of all kinds that have begun
  std::uint8_t recent[12];            // index of the n-th of them, at n % 12
};
static_assert(sizeof(ActionState) == 352);

// Slots of one glove. Writer: its device thread, which writes the results of a sample before the
// sample itself.
struct GloveSlots {
  Channel<GloveSample> samples;
  Channel<PostureSample> posture;
  alignas(64) SeqSlot<PostureState> posture_state;
};

// Slots of one tracker. Writer: its device thread; `frames` is written by the daemon, as it starts.
struct TrackerSlots {
  Channel<TrackerSample> stations[kStations];  // index: station - 1
  alignas(64) SeqSlot<TrackerFrames> frames;
};

// The sources of actions: the devices, in the order of DevicesSegment::health, the panel, and the
// hands, which make gestures, in the order of DevicesSegment::hand.
inline constexpr std::size_t kPanelSource = kMostDevices;
inline constexpr std::size_t kFirstHandSource = kMostDevices + 1;
inline constexpr std::size_t kActionSources = kFirstHandSource + kMostHands;

// Has room for the largest number of devices that may be configured. Only those that are configured
// have names in the table of fields: health and actions in the order of the configuration, samples
// in the order of the devices of their kind.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): offsets are a contract
struct DevicesSegment {
  Header header;
  alignas(64) SeqSlot<DeviceHealth> health[kMostDevices];  // writer: each device's thread
  GloveSlots glove[kMostGloves];
  TrackerSlots tracker[kMostTrackers];
  Channel<BallSample> ball[kMostBalls];                      // writer: each ball's device thread
  Channel<TouchSample> touch[kMostTouches];                  // writer: each one's device thread
  Channel<HandSample> hand[kMostHands];                      // writer: its tracker's device thread
  Channel<GpioSample> gpio;                                  // writer: the panel's thread
  alignas(64) SeqSlot<DeviceHealth> gpio_health;             // writer: the panel's thread
  alignas(64) SeqSlot<ActionState> actions[kActionSources];  // writer: each device's thread
  alignas(64) SeqSlot<GestureState> gesture[kMostHands];     // writer: its tracker's device thread
  alignas(64) Field fields[kMostDevicesFields];              // writer: the daemon, as it starts
};

// Statistics of the wall, written once per frame by the wall's thread. Shares are 0..1.
struct WallStats {
  std::int64_t updated_ns;
  std::uint64_t frames;        // frames drawn and presented since the start
  std::uint64_t deadlines;     // deadlines passed while something moved, since the start
  std::uint64_t late;          // deadlines of these that were missed
  std::uint32_t cost;          // cost of the last frame's detail, in cost_unit
  std::uint32_t detail_step;   // step of the content's detail: 0 is full detail
  std::uint32_t detail_steps;  // number of these steps
  std::uint32_t moving;        // 1 while something moves
  std::uint32_t full_detail;   // 1 while the model is shown at full detail
  std::uint32_t longest_late;  // longest sequence of late frames since the start
  float rate_asked_hz;         // desired rate
  float rate_held_hz;  // deadlines met in the last second; an unchanged picture meets its deadline
  float late_share_1s, late_share_1min, late_share;  // of the last second, minute, since the start
  float work_ms;         // work of the last frame, from its begin to its last pixel
  float work_median_ms;  // median of the last second's frames
  float utilisation;     // work / period of the last second's moving frames
  float head_room;       // time reserve of the governor, share of the period
  // The governor's cost model: work = fixed + coefficient * cost^cost_exponent.
  float cost_fixed_ms;
  float cost_coefficient_us;
  float input_age_ms;              // age of the newest sample when the last frame began
  float still_to_full_s;           // last time from standstill to full detail
  std::uint32_t resumed;           // times that motion resumed after a standstill, since the start
  std::uint32_t resumed_late;      // times of these that the first frame missed its deadline
  std::uint32_t grabbed;           // 1 while a hand holds the model
  char mode[16];                   // mode of the ball: "object" or "fly"
  char posture[20];                // current posture; empty: none
  std::uint32_t scale_divisor;     // 2 while moving tiles are drawn at half size, otherwise 1
  float rate_now_hz;               // desired rate divided by rate_divisor
  std::uint32_t rate_divisor;      // 1; 2 to 4 while even the coarsest detail takes too long
  std::uint32_t operator_coarser;  // 1 while the operator's view is coarser to save time
  std::uint32_t ladder_steps;      // changes of these degradations, up and down, since the start
  std::uint32_t budget;            // cost that the next moving frame may have
  std::uint32_t held_cost;         // cost set by hand; 0: the governor chooses it
  float cost_exponent;             // exponent of the cost model
  float oscillation;               // (p95 - p5) / mean of the last 100 moving frames' costs
  std::uint32_t settle_frames;     // last settling: late frames until five in a row were in time
  float still_to_first_s;          // last time from standstill to the first finer picture
  std::uint32_t work_histogram[32];  // moving frames by work / period since the start, in buckets
                                     // of 1/16; the last one has all longer ones
  std::uint32_t returned;    // times that the initial view returned by itself, since the start
  std::uint32_t full_cost;   // cost of full detail
  char cost_unit[16];        // unit of costs, of the content that is shown: "triangles"
  std::uint32_t least_cost;  // the lowest cost that the governor chooses
};
static_assert(sizeof(WallStats) == 360 && offsetof(WallStats, cost) == 32);
static_assert(offsetof(WallStats, rate_now_hz) == 160 && offsetof(WallStats, scale_divisor) == 156);

// Steps of a frame; stepName() of daemon/cli/wall/trace_json.has their names.
enum class StepKind : std::uint16_t {
  kInput = 0,     // reads the slots of all devices
  kScene = 1,     // applies the input to camera, objects, content
  kGovernor = 2,  // chooses the detail of this frame
  kCut = 3,       // computes the cut of the dendrogram
  kUpload = 4,    // uploads the cut
  kDraw = 5,      // clears and draws one tile
  kReadBack = 6,  // reads one tile's pixels back
  kPresent = 7,   // passes the frame to all outputs
  kRefine = 8     // draws a slice of a finer picture while nothing moves
};

struct TraceStep {
  std::uint32_t begin_ns;  // since the frame's begin
  std::uint32_t length_ns;
  StepKind kind;
  std::uint16_t tile;  // index of the tile, from 0; for kDraw, kReadBack, kRefine
};

// Times of one frame, or of one period while nothing moves, and of its steps. A period that the
// frame before ran over has an entry without steps.
struct FrameTrace {
  std::int64_t begin_ns, end_ns, deadline_ns;  // CLOCK_MONOTONIC
  std::uint64_t period;                        // number of the period since the start
  std::uint32_t cost;                          // of its detail, in WallStats::cost_unit
  std::uint32_t moving, late;
  std::uint32_t count;  // number of steps; may exceed 32, of which the first are stored
  TraceStep steps[32];
};
static_assert(sizeof(TraceStep) == 12 && sizeof(FrameTrace) == 48 + 32 * 12);

// Interaction of people with the wall: pointing, snapshots, contents, and what is shown while
// nobody is there. Written once per period.
struct WallInteraction {
  enum Pointing : std::uint32_t { kNone = 0, kAtWall = 1, kAtModel = 2 };
  enum Shown : std::uint32_t { kPicture = 0, kBlank = 1, kFrozen = 2 };
  // kPlaylistOff: the playlist does not begin by itself; kPlaylistWaiting: it will.
  enum Playlist : std::uint32_t { kPlaylistOff = 0, kPlaylistWaiting = 1, kPlaylistRunning = 2 };

  std::int64_t updated_ns;
  std::uint32_t pointing;
  std::int32_t pixel[2];    // pixel pointed at, from the frame's upper left corner; -1, -1: none
  float at_model_m[3];      // point of the bounding sphere pointed at, model coordinates [m]
  std::uint32_t snapshots;  // snapshots written since the start
  std::uint32_t content;    // content shown: 0 the model, 1 .. the configuration's contents, then a
                            // file that is not in the configuration
  std::uint32_t shown;      // Shown
  std::uint32_t playlist;   // Playlist
  float light;  // brightness of the picture, as a share of the full light; below 1: dimmed
};
static_assert(sizeof(WallInteraction) == 56 && offsetof(WallInteraction, snapshots) == 32);

// State of one output of the wall.
struct OutputStats {
  char name[24];         // of the configuration
  char kind[24];         // "shared_memory", "png"
  std::uint64_t frames;  // shown since the start
  std::uint32_t failed;  // 1 while it cannot show frames
  float shown_hz;        // frames shown in the last second
  float late_share;      // of its frames while something moved, since the start: shown too late
  char fault[140];       // why it failed; empty while it works
  // What the output was found to show when it was last read back: 0 not read, 1 what was meant,
  // 2 black, 3 an older frame, 4 parts of two frames, 5 a picture that is not the wall's.
  std::uint32_t picture;
  float picture_ms;         // time that reading it back took
  char picture_fault[112];  // what is wrong with it; empty while `picture` is 0 or 1
};
static_assert(sizeof(OutputStats) == 328);

// Written once a period.
struct WallOutputs {
  std::uint32_t count;  // of outputs that are used
  std::uint32_t reserved;
  OutputStats outputs[32];
};

// The content that is shown, and what became of the last request for one. Written once a period.
struct WallContent {
  std::int64_t updated_ns;
  char name[64];   // of the configuration, or of a file that is not in it
  char kind[16];   // "model", "picture", "panorama"
  char slide[64];  // for slides: name of the slide that is shown
  // Number of the last request (`merlin show`) that was shown or refused; each number stays for at
  // least a tenth of a second. Requests may end in another order than they were made.
  std::uint32_t finished;
  char refused[260];  // why the content of that request cannot be shown; empty if it is shown
};
static_assert(sizeof(WallContent) == 416 && offsetof(WallContent, finished) == 152);

// What the wall will do by itself while nobody touches it, and what hides the content. Written once
// a period. A time is negative while its event is not going to happen.
struct WallIdle {
  std::int64_t updated_ns;
  float playlist_in_s;     // until the playlist begins by itself
  float next_in_s;         // until it shows its next content
  float dim_in_s;          // until the picture begins to become darker
  std::uint32_t testcard;  // 1 while a test card covers the picture
};
static_assert(sizeof(WallIdle) == 24);

// The panel on the operator's tile. Written when it changes; never without a panel.
struct WallPanel {
  std::int64_t updated_ns;
  std::int32_t x, y, width, height;  // in the frame, from its upper left corner [px]
  std::uint32_t by_ball;             // 1 while the ball operates the panel
  std::uint32_t reserved;
};
static_assert(sizeof(WallPanel) == 32);

// The sentence that the wall shows over the picture for a few seconds, at a client's request.
// Written when it changes.
struct WallNotice {
  std::int64_t updated_ns;
  char text[152];  // empty: nothing
};
static_assert(sizeof(WallNotice) == 160);

// Each part has cache lines of its own, even if two have the same writer.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding)
struct WallSegment {
  Header header;
  alignas(64) SeqSlot<WallStats> stats;  // writer: the wall's thread
  Channel<FrameTrace> trace;             // writer: the wall's thread; the last 256 periods
  alignas(64) SeqSlot<WallInteraction> interaction;  // writer: the wall's thread
  // Name of the frame buffer's segment, "/merlin-framebuffer"; empty until it exists.
  alignas(64) char framebuffer[64];
  alignas(64) SeqSlot<WallOutputs> outputs;  // writer: the wall's thread
  alignas(64) SeqSlot<WallContent> content;  // writer: the wall's thread
  alignas(64) SeqSlot<WallIdle> idle;        // writer: the wall's thread
  alignas(64) SeqSlot<WallPanel> panel;      // writer: the wall's thread
  alignas(64) SeqSlot<WallNotice> notice;    // writer: the daemon's main thread
  alignas(64) Field fields[kMostFields];     // writer: the daemon, as it starts
};

}  // namespace merlin::shm
