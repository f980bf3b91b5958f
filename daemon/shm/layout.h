// The layout of MERLIN's shared memory, which client processes map. Clients: read this file first.
//
// Two segments, read-only for clients: /merlin-devices (the devices' samples) and /merlin-wall (the
// wall's statistics). Each starts with a Header and contains a table that describes all its fields,
// including those of the header, so that readers in C, C++ and Python need no header file;
// README.md in this folder names an example program for each language. The frame buffer,
// /merlin-framebuffer, has the same kind of table (render/out/shared_frame_layout.h).
//
// Each slot has exactly one writer, which a comment at the slot names. The segments contain no
// pointers and no locks. The meaning of a field never changes. New fields are only appended; any
// change of an offset increments kVersion, and a client must refuse a version that it does not
// know. The table of fields is at the end and may move: the header contains its offset.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "daemon/base/field_table.h"
#include "daemon/shm/channel.h"
#include "daemon/shm/seq_slot.h"
#include "drivers/port/samples.h"

namespace merlin::shm {

inline constexpr std::uint32_t kMagic = 0x4E4C524D;  // the bytes "MRLN" in memory (little-endian)
inline constexpr std::uint32_t kVersion = 6;
inline constexpr std::size_t kMostFields = 704;  // capacity of the table in the wall's segment
inline constexpr std::size_t kMostDevicesFields = 2304;  // capacity of that of the devices' segment

// Header of a segment. A reader only needs to know the layout of its first 40 bytes: they contain
// the offset of the table of fields, which describes everything else. The segment of the frame
// buffer begins with the same 40 bytes.
struct Header {
  std::uint32_t magic, version;
  std::uint64_t size;        // size of the whole segment [bytes]
  std::uint64_t generation;  // differs in each run of the daemon; if it changes, reopen the segment
  std::uint32_t field_offset;  // offset of the table of fields from the segment's start [bytes]
  std::uint32_t field_count;   // number of entries in the table
  // Size of an entry of the table [bytes]; may exceed sizeof(Field) in a later version.
  std::uint32_t field_size;
  std::uint32_t pid;
  std::atomic<std::int64_t> heartbeat_ns;  // CLOCK_MONOTONIC time, set ten times a second
  std::int64_t started_ns;                 // CLOCK_MONOTONIC
  // CLOCK_REALTIME minus CLOCK_MONOTONIC, measured with each heartbeat: add it to a time stamp to
  // get UTC in nanoseconds since 1970. It jumps when the system's clock is set.
  std::atomic<std::int64_t> realtime_offset_ns;
  char status_endpoint[108];   // address of the ZeroMQ PUB socket: JSON documents by topic
  char command_endpoint[108];  // address of the ZeroMQ REP socket: commands
};
static_assert(offsetof(Header, field_offset) == 24 && offsetof(Header, heartbeat_ns) == 40);
static_assert(offsetof(Header, status_endpoint) == 64 && sizeof(Header) == 280);

// Maximum number of actions, i.e. of the entries of kActions in daemon/base/commands.h.
inline constexpr std::size_t kMostActions = 64;

// State of the actions to which the inputs of one source (a device, the panel or a hand) are bound.
// It is published when an action begins or ends. The arrays are indexed like kActions in
// daemon/base/commands.h; other processes must find an action by the name of its field, since the
// indexes differ between releases.
struct ActionState {
  std::int64_t changed_ns;   // time of the input that changed this state last; 0: no input yet
  std::uint64_t generation;  // differs in each run of the daemon, which counts from 0
  std::uint32_t begun[kMostActions];  // how many times each action has begun
  std::uint8_t held[kMostActions];    // 1 while the action is held; 0 for one that happens once
  std::uint32_t sequence;             // how many actions have begun, all kinds together
  std::uint8_t recent[12];  // the last 12 actions that have begun: index of number n at [n % 12]
};
static_assert(sizeof(ActionState) == 352);

// Slots of one glove. Writer: the thread of the glove, which publishes the posture of each sample
// before the sample itself.
struct GloveSlots {
  Channel<GloveSample> samples;
  Channel<PostureSample> posture;
  alignas(64) SeqSlot<PostureState> posture_state;
};

// Slots of one tracker. Writer: the thread of the tracker; but `frames` is written by the daemon,
// at its start and when a changed configuration recreates the tracker.
struct TrackerSlots {
  Channel<TrackerSample> stations[kStations];  // index: station - 1
  alignas(64) SeqSlot<TrackerFrames> frames;
};

// Indexes in DevicesSegment::actions: first the devices, in the order of DevicesSegment::health,
// then the panel, then the hands, whose gestures are inputs, in the order of DevicesSegment::hand.
inline constexpr std::size_t kPanelSource = kMostDevices;
inline constexpr std::size_t kFirstHandSource = kMostDevices + 1;
inline constexpr std::size_t kActionSources = kFirstHandSource + kMostHands;

// The segment of the devices. It has room for the largest number of devices that may be configured,
// but the table of fields lists only the slots of configured devices. `health` and `actions` are in
// the order of the configuration; the slots of samples are indexed by the place of the device among
// those of its kind.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): clients rely on the offsets
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
  alignas(64) SeqSlot<ActionState> actions[kActionSources];  // writer: each source's thread
  alignas(64) SeqSlot<GestureState> gesture[kMostHands];     // writer: its tracker's device thread
  alignas(64) Field fields[kMostDevicesFields];              // writer: the daemon, as it starts
};

// Statistics of the wall, published once per period by the wall's thread. Shares are 0..1.
struct WallStats {
  std::int64_t updated_ns;
  std::uint64_t frames;        // number of frames passed to the outputs since the start
  std::uint64_t deadlines;     // number of deadlines while something moved, since the start
  std::uint64_t late;          // how many of these deadlines were missed
  std::uint32_t cost;          // cost of the detail of the last frame, in cost_unit
  std::uint32_t detail_step;   // detail step of the last frame; 0: full detail
  std::uint32_t detail_steps;  // number of detail steps of the content
  std::uint32_t moving;        // 1 while something moves
  std::uint32_t full_detail;   // 1 while the content is shown at full detail
  std::uint32_t longest_late;  // longest run of missed deadlines since the start
  float rate_asked_hz;         // desired frame rate: as configured, or as set by command
  // rate_now_hz times the share of the last second's deadlines that were met. While nothing moves,
  // every deadline counts as met.
  float rate_held_hz;
  // Share of the deadlines that were missed while something moved: in the last second, in the last
  // minute, and since the start.
  float late_share_1s, late_share_1min, late_share;
  float work_ms;         // time of the last moving frame, from its begin to its delivery
  float work_median_ms;  // median of work_ms over the moving frames of the last second
  float utilisation;     // mean of work / period over the moving frames of the last second
  float head_room;       // time that the governor keeps in reserve, as a share of the period
  // The governor's cost model: work = fixed + coefficient * cost^cost_exponent.
  float cost_fixed_ms;
  float cost_coefficient_us;
  float input_age_ms;           // age of the newest device sample when the last frame began
  float still_to_full_s;        // time from the last standstill to full detail
  std::uint32_t resumed;        // how many times motion resumed after a standstill, since the start
  std::uint32_t resumed_late;   // how often the first frame after such a standstill was late
  std::uint32_t grabbed;        // 1 while a hand holds the model
  char mode[16];                // what the ball moves: "object" or "fly" (the viewer)
  char posture[20];             // name of the current posture; empty: none
  std::uint32_t scale_divisor;  // 2 while moving tiles are drawn at half width and height, else 1
  float rate_now_hz;            // frame rate at present: rate_asked_hz / rate_divisor
  std::uint32_t rate_divisor;   // 1; more (2 to 4) while even the coarsest detail takes too long
  std::uint32_t operator_coarser;  // 1 while the operator's view is coarser to save time
  // How often scale_divisor, rate_divisor or operator_coarser has changed, up or down, since the
  // start.
  std::uint32_t ladder_steps;
  std::uint32_t budget;     // largest cost that the next moving frame may have, in cost_unit
  std::uint32_t held_cost;  // budget fixed by command, in cost_unit; 0: the governor chooses it
  float cost_exponent;      // exponent of the governor's cost model
  float oscillation;        // (p95 - p5) / mean of the last 100 moving frames' costs
  // Length of the last disturbance, in deadlines: from the first late one until five in a row were
  // met (FrameStats::settleFrames()).
  std::uint32_t settle_frames;
  float still_to_first_s;  // time from the last standstill to its first finer picture
  // Histogram of work / period of the moving frames since the start. Each bucket is 1/16 wide; the
  // last one also counts all larger values.
  std::uint32_t work_histogram[32];
  std::uint32_t returned;   // how often the initial view returned by itself, since the start
  std::uint32_t full_cost;  // cost of full detail, in cost_unit
  char cost_unit[16];  // unit of all costs here, which depends on the content shown: "triangles"
  std::uint32_t least_cost;  // the lowest cost that the governor chooses, in cost_unit
};
static_assert(sizeof(WallStats) == 360 && offsetof(WallStats, cost) == 32);
static_assert(offsetof(WallStats, rate_now_hz) == 160 && offsetof(WallStats, scale_divisor) == 156);

// Kinds of steps of a frame. stepName() (daemon/cli/wall/trace_json.h) returns their names.
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
  std::uint32_t begin_ns;  // time since the frame's begin
  std::uint32_t length_ns;
  StepKind kind;
  std::uint16_t tile;  // index of the tile, from 0; valid for kDraw, kReadBack and kRefine
};

// Times of one frame and its steps; while nothing moves, of one period. If a frame takes longer
// than its period, each further period that it covers has an entry without steps.
struct FrameTrace {
  std::int64_t begin_ns, end_ns, deadline_ns;  // CLOCK_MONOTONIC
  std::uint64_t period;                        // number of the period, counted from 0 at the start
  std::uint32_t cost;  // cost of the frame's detail, in WallStats::cost_unit
  std::uint32_t moving, late;
  std::uint32_t count;  // number of entries used in `steps`; further steps of a frame are dropped
  TraceStep steps[32];
};
static_assert(sizeof(TraceStep) == 12 && sizeof(FrameTrace) == 48 + 32 * 12);

// What people do with the wall (point at it, take snapshots, choose contents), and what it shows
// while nobody is there. Published once per period.
struct WallInteraction {
  enum Pointing : std::uint32_t { kNone = 0, kAtWall = 1, kAtModel = 2 };
  enum Shown : std::uint32_t { kPicture = 0, kBlank = 1, kFrozen = 2 };
  // kPlaylistOff: the playlist does not begin by itself. kPlaylistWaiting: it begins by itself
  // after a time without input.
  enum Playlist : std::uint32_t { kPlaylistOff = 0, kPlaylistWaiting = 1, kPlaylistRunning = 2 };

  std::int64_t updated_ns;
  std::uint32_t pointing;  // a value of Pointing
  std::int32_t pixel[2];   // pixel pointed at, from the frame's upper left corner; -1, -1: none
  float at_model_m[3];  // point pointed at on the model's bounding sphere, in model coordinates [m]
  std::uint32_t snapshots;  // snapshots written since the start
  // Number of the content shown. 0: /wall/model. From 1 on: the contents of the configuration, in
  // their order; the number after the last one stands for a file that is not in the configuration.
  std::uint32_t content;
  std::uint32_t shown;     // a value of Shown
  std::uint32_t playlist;  // a value of Playlist
  float light;  // brightness of the picture, as a share of the full light; below 1: dimmed
};
static_assert(sizeof(WallInteraction) == 56 && offsetof(WallInteraction, snapshots) == 32);

// State of one output of the wall.
struct OutputStats {
  char name[24];         // as configured
  char kind[24];         // kind of the output: "shared_memory", "png" ...
  std::uint64_t frames;  // number of frames shown since the start
  std::uint32_t failed;  // 1 while the output cannot show frames
  float shown_hz;        // frames shown in the last second
  float late_share;      // share of its moving frames that were shown too late, since the start
  char fault[140];       // why the output failed; empty while it works
  // What the output showed when its picture was last read back. 0: not read back, 1: the picture
  // that it was sent, 2: black, 3: an older frame, 4: parts of two frames, 5: a picture that is not
  // the wall's (render::out::PictureVerdict).
  std::uint32_t picture;
  float picture_ms;         // time that reading the picture back took
  char picture_fault[112];  // what is wrong with the picture; empty while `picture` is 0 or 1
};
static_assert(sizeof(OutputStats) == 328);

// State of all outputs. Published once per period.
struct WallOutputs {
  std::uint32_t count;  // number of entries used in `outputs`
  std::uint32_t reserved;
  OutputStats outputs[32];
};

// The content that is shown, and the result of the last request to show a content. Published once
// per period.
struct WallContent {
  std::int64_t updated_ns;
  char name[64];   // name of the content: as configured, or of a file in the content folder
  char kind[16];   // "model", "picture", "panorama"
  char slide[64];  // name of the slide that is shown; empty if the content is not slides
  // Number of the last request (`merlin show`) that is done, i.e. whose content was shown or
  // refused. Each number is published for at least a tenth of a second. Requests may be done in
  // another order than they were made.
  std::uint32_t finished;
  char refused[260];  // why request `finished` was refused; empty if its content was shown
};
static_assert(sizeof(WallContent) == 416 && offsetof(WallContent, finished) == 152);

// What the wall will do by itself while nobody touches it, and whether a test card hides the
// content. Published once per period. A time is negative if its event will not happen.
struct WallIdle {
  std::int64_t updated_ns;
  float playlist_in_s;     // time until the playlist begins by itself
  float next_in_s;         // time until the playlist shows its next content
  float dim_in_s;          // time until the picture begins to become darker
  std::uint32_t testcard;  // 1 while a test card covers the picture
};
static_assert(sizeof(WallIdle) == 24);

// The panel on the operator's tile. Published when it changes; never published if there is no
// panel.
struct WallPanel {
  std::int64_t updated_ns;
  std::int32_t x, y, width, height;  // place in the frame, from its upper left corner [px]
  std::uint32_t by_ball;             // 1 while the ball operates the panel
  std::uint32_t reserved;
};
static_assert(sizeof(WallPanel) == 32);

// The sentence that the wall shows over the picture for a few seconds at a client's request.
// Published when it changes.
struct WallNotice {
  std::int64_t updated_ns;
  char text[152];  // NUL-ended; empty: no sentence is shown
};
static_assert(sizeof(WallNotice) == 160);

// The segment of the wall. Each part has cache lines of its own, even if two parts have the same
// writer.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding)
struct WallSegment {
  Header header;
  alignas(64) SeqSlot<WallStats> stats;  // writer: the wall's thread
  Channel<FrameTrace> trace;             // the last 256 periods; writer: the wall's thread
  alignas(64) SeqSlot<WallInteraction> interaction;  // writer: the wall's thread
  // Name of the segment of the frame buffer, such as "/merlin-framebuffer"; empty if no output of
  // kind shared_memory is configured. Written once, at the daemon's start.
  alignas(64) char framebuffer[64];
  alignas(64) SeqSlot<WallOutputs> outputs;  // writer: the wall's thread
  alignas(64) SeqSlot<WallContent> content;  // writer: the wall's thread
  alignas(64) SeqSlot<WallIdle> idle;        // writer: the wall's thread
  alignas(64) SeqSlot<WallPanel> panel;      // writer: the wall's thread
  alignas(64) SeqSlot<WallNotice> notice;    // writer: the daemon's main thread
  alignas(64) Field fields[kMostFields];     // writer: the daemon, as it starts
};

}  // namespace merlin::shm
