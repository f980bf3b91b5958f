#include "daemon/cli/wall/trace_json.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include <nlohmann/json.hpp>

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kProcess = 1, kWallTrack = 1, kOtherTrack = 100;

double microseconds(std::int64_t ns) { return static_cast<double>(ns) / 1000; }

Json event(const std::string& name, const char* phase, double at_us, int track) {
  return {{"name", name}, {"ph", phase}, {"ts", at_us}, {"pid", kProcess}, {"tid", track}};
}

Json trackName(const std::string& name, int track) {
  Json json = event("thread_name", "M", 0, track);
  json["args"] = {{"name", name}};
  return json;
}

bool ofATile(shm::StepKind kind) {
  return kind == shm::StepKind::kDraw || kind == shm::StepKind::kReadBack;
}

Json stepEvent(const shm::TraceStep& step, double frame_us, int track) {
  std::string name = stepName(step.kind);
  if (ofATile(step.kind)) name += " tile " + std::to_string(step.tile + 1);
  Json json = event(name, "X", frame_us + microseconds(step.begin_ns), track);
  json["dur"] = microseconds(step.length_ns);
  json["cat"] = stepName(step.kind);
  return json;
}

// Returns the name of a frame in the trace. A frame without steps was missed, because the frame
// before it took longer than its period.
const char* nameOf(const shm::FrameTrace& f) {
  if (f.moving == 0) return "still";
  return f.count == 0 ? "missed" : "frame";
}

void addFrame(const shm::FrameTrace& f, std::int64_t from_ns, Json& events) {
  const double at = microseconds(f.begin_ns - from_ns);
  Json frame = event(nameOf(f), "X", at, kWallTrack);
  frame["dur"] = microseconds(f.end_ns - f.begin_ns);
  frame["cat"] = "frame";
  frame["args"] = {{"period", f.period},
                   {"cost", f.cost},
                   {"late", f.late != 0},
                   {"deadline_us", microseconds(f.deadline_ns - from_ns)}};
  events.push_back(std::move(frame));
  const std::size_t count = std::min<std::size_t>(f.count, std::size(f.steps));
  // An upload that begins before the previous step of the first thread ends belongs to the second
  // thread; so do the steps of tiles after that upload.
  std::int64_t ended = 0;
  bool other = false;
  for (std::size_t i = 0; i < count; ++i) {
    const shm::TraceStep& step = f.steps[i];
    if (step.kind == shm::StepKind::kUpload)
      other = step.begin_ns < ended;
    else if (!ofATile(step.kind))
      other = false;
    if (!other) ended = std::int64_t{step.begin_ns} + step.length_ns;
    events.push_back(stepEvent(step, at, other ? kOtherTrack : kWallTrack));
  }
  if (f.late != 0) {
    Json late = event("late", "i", microseconds(f.deadline_ns - from_ns), kWallTrack);
    late["s"] = "t";
    events.push_back(std::move(late));
  }
  Json counter = event("detail", "C", at, kWallTrack);
  counter["args"] = {{"cost", f.cost}};
  events.push_back(std::move(counter));
}

}  // namespace

const char* stepName(shm::StepKind kind) {
  constexpr const char* kNames[] = {"input", "scene",     "governor", "cut",   "upload",
                                    "draw",  "read-back", "present",  "refine"};
  const auto i = static_cast<std::size_t>(kind);
  return i < std::size(kNames) ? kNames[i] : "other";
}

std::string traceJson(std::span<const shm::FrameTrace> frames,
                      std::span<const SampleInstant> samples) {
  Json events = Json::array();
  events.push_back(trackName("wall", kWallTrack));
  events.push_back(trackName("wall, second thread", kOtherTrack));
  const std::int64_t from = frames.empty() ? 0 : frames.front().begin_ns;
  for (const shm::FrameTrace& f : frames) addFrame(f, from, events);
  std::vector<std::string> tracks;
  for (const SampleInstant& s : samples) {
    auto track = std::find(tracks.begin(), tracks.end(), s.device);
    if (track == tracks.end()) {
      tracks.push_back(s.device);
      track = tracks.end() - 1;
      events.push_back(trackName(s.device, kWallTrack + static_cast<int>(tracks.size())));
    }
    const int number = kWallTrack + 1 + static_cast<int>(track - tracks.begin());
    Json json = event("first byte", "i", microseconds(s.at_ns - from), number);
    json["s"] = "t";
    events.push_back(std::move(json));
  }
  return Json{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}.dump() + "\n";
}

}  // namespace merlin::cli
