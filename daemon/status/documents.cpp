#include "daemon/status/documents.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/commands.h"
#include "daemon/base/fixed_text.h"
#include "daemon/status/add_member.h"

namespace merlin::status {
namespace {

using Json = nlohmann::ordered_json;

// ISO 8601, to the microsecond: "2026-11-23T14:05:07.000250Z".
std::string isoUtc(std::int64_t utc_ns) {
  const std::int64_t us = utc_ns / 1000;
  const auto seconds = static_cast<std::time_t>(us / 1'000'000);
  std::tm tm{};
  ::gmtime_r(&seconds, &tm);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", tm.tm_year + 1900, tm.tm_mon + 1,
                     tm.tm_mday, tm.tm_hour, tm.tm_min, tm.tm_sec, us % 1'000'000);
}

std::string timeUtc(const shm::Header& header, Timestamp now) {
  return isoUtc(toNanoseconds(now) + header.realtime_offset_ns.load(std::memory_order_relaxed));
}

// Rounds to three decimals; 0 if not finite.
double round3(double value) { return std::isfinite(value) ? std::round(value * 1000) / 1000 : 0; }

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false,
                   Json::error_handler_t::replace);  // device texts may be invalid UTF-8
}

template <std::size_t N>
std::string text(const char (&field)[N]) {
  return std::string(textIn(field));
}

// Rounds to six decimals (a micrometre, a microradian), enough for measurements.
template <typename T>
Json list(std::span<const T> values) {
  Json json = Json::array();
  for (const T v : values) {
    const double wide = static_cast<double>(v);
    json.push_back(std::isfinite(wide) ? std::round(wide * 1e6) / 1e6 : 0);
  }
  return json;
}

template <typename T>
Json integers(std::span<const T> values) {
  Json json = Json::array();
  for (const T v : values) json.push_back(static_cast<int>(v));
  return json;
}

// Short health of each device, for a client that only receives samples.
Json briefHealth(const shm::DeviceSlots& devices) {
  Json all = Json::object();
  for (const auto& [device, slot] : devices.health) {
    const auto h = slot->read();
    if (!h) continue;
    all[device] = {{"state", static_cast<std::uint32_t>(h->state)},
                   {"since_ns", h->since_ns},
                   {"identity", text(h->identity)},
                   {"reason", text(h->reason)},
                   {"samples", h->samples},
                   {"reconnects", h->reconnects},
                   {"rate_hz", round3(static_cast<double>(h->rate_hz))}};
  }
  return all;
}

Json handJson(const HandSample& h) {
  return {{"received_ns", h.received_ns},
          {"glove_ns", h.glove_ns},
          {"counter", h.counter},
          {"flags", h.flags},
          {"joint_rad", list(std::span<const float>(h.joint_rad))},
          {"position_m", list(std::span<const float>(h.position_m))},
          {"orientation_wxyz", list(std::span<const float>(h.orientation_wxyz))},
          {"velocity_m_s", list(std::span<const float>(h.velocity_m_s))},
          {"turn_rad_s", list(std::span<const float>(h.turn_rad_s))},
          {"delay_s", h.delay_s}};
}

// Null while no hand points; "pixel" is null if no wall tile shows the place pointed at.
Json pointerJson(const shm::WallInteraction& h) {
  if (h.pointing == shm::WallInteraction::kNone) return nullptr;
  Json pixel = nullptr;
  if (h.pixel[0] >= 0) pixel = integers(std::span<const std::int32_t>(h.pixel));
  return {{"at", h.pointing == shm::WallInteraction::kAtModel ? "model" : "wall"},
          {"pixel", std::move(pixel)},
          {"at_model_m", list(std::span<const float>(h.at_model_m))}};
}

double ageSeconds(std::int64_t then_ns, Timestamp now) {
  return round3(toSeconds(now - fromNanoseconds(then_ns)));
}

Json deviceJson(const DeviceHealth& h, Timestamp now) {
  return {{"health", shm::healthName(h, now)},
          {"since_s", ageSeconds(h.since_ns, now)},
          {"port", text(h.port)},
          {"identity", text(h.identity)},
          {"reason", text(h.reason)},
          {"rate_hz", round3(h.rate_hz)},
          {"samples", h.samples},
          {"reconnects", h.reconnects},
          {"bad_packets", h.bad_packets},
          {"bad_bytes", h.bad_bytes}};
}

// The current posture (after the minimum hold time), the one of the newest record, and its margin.
Json postureJson(const shm::DeviceSlots::Glove& glove, Timestamp now) {
  const auto held = glove.posture_state->read();
  const auto shown = glove.posture->newest();
  if (!held || !shown) return nullptr;
  return {{"name", text(held->name)},
          {"code", held->code},
          {"held_s", ageSeconds(held->since_ns, now)},
          {"entered", held->entered},
          {"seen", text(held->seen)},
          {"seen_code", shown->code},
          {"margin", round3(static_cast<double>(held->margin))},
          {"activation", list(std::span<const float>(shown->activation))},
          {"age_s", ageSeconds(held->received_ns, now)}};
}

// The servers for other programs, with their counters of refused and closed connections.
Json serversJson(const std::vector<net::ServerHealth>& servers) {
  Json all = Json::object();
  for (const net::ServerHealth& s : servers) {
    all[s.name] = {{"state", s.failure.empty() ? "ok" : "failed"},
                   {"reason", s.failure},
                   {"connections", s.report.connections},
                   {"accepted", s.report.accepted},
                   {"refused", s.report.refused},
                   {"replaced", s.report.replaced},
                   {"silent", s.report.silent},
                   {"broken", s.report.broken},
                   {"slow", s.report.slow},
                   {"last", s.report.last}};
  }
  return all;
}

std::string postureName(const shm::DeviceSlots::Glove& glove) {
  if (const auto held = glove.posture_state->read()) return text(held->name);
  const auto posture = glove.posture->newest();
  return posture ? text(posture->name) : "";
}

// That of the first glove that shows one.
std::string postureName(const shm::DeviceSlots& devices) {
  for (const auto& glove : devices.gloves) {
    if (std::string name = postureName(glove); !name.empty()) return name;
  }
  return "";
}

Json posturesJson(const shm::DeviceSlots& devices, Timestamp now) {
  Json all = Json::object();
  for (const auto& glove : devices.gloves) all[glove.name] = postureJson(glove, now);
  return all;
}

Json devicesJson(const shm::DeviceSlots& devices, Timestamp now) {
  Json all = Json::object();
  for (const auto& [device, slot] : devices.health) {
    if (const auto health = slot->read()) all[device] = deviceJson(*health, now);
  }
  return all;
}

}  // namespace

std::string devicesStatus(const shm::DeviceSlots& devices, Timestamp now,
                          const std::vector<net::ServerHealth>& servers) {
  return dump({{"role", "devices"},
               {"pid", devices.header->pid},
               {"time_utc", timeUtc(*devices.header, now)},
               {"uptime_s", ageSeconds(devices.header->started_ns, now)},
               {"posture", postureName(devices)},
               {"posture_detail",
                devices.gloves.empty() ? Json(nullptr) : postureJson(devices.gloves[0], now)},
               {"postures", posturesJson(devices, now)},
               {"devices", devicesJson(devices, now)},
               {"servers", serversJson(servers)}});
}

namespace {

// In the order of shm::OutputStats::picture.
constexpr const char* kPictures[] = {"unchecked", "right", "black", "frozen", "torn", "foreign"};

const char* pictureName(const shm::OutputStats& o) {
  return kPictures[o.picture < std::size(kPictures) ? o.picture : 0];
}

Json outputsJson(const shm::WallSegment& segment) {
  Json json = Json::object();
  const auto all = segment.outputs.read();
  if (!all) return json;
  for (const shm::OutputStats& o : std::span(all->outputs).first(all->count)) {
    json[text(o.name)] = {{"kind", text(o.kind)},
                          {"health", o.failed != 0 ? "failed" : "ok"},
                          {"reason", text(o.fault)},
                          {"frames", o.frames},
                          {"shown_hz", round3(o.shown_hz)},
                          {"late_percent", round3(100 * o.late_share)},
                          {"picture", pictureName(o)},
                          {"picture_reason", text(o.picture_fault)},
                          {"picture_ms", round3(o.picture_ms)}};
  }
  return json;
}

constexpr std::string_view kTriangles = "triangles";

Json detailJson(const shm::WallStats& s) {
  return {{"step", s.detail_step},    {"steps", s.detail_steps},  {"cost", s.cost},
          {"full_cost", s.full_cost}, {"held_cost", s.held_cost}, {"unit", text(s.cost_unit)}};
}

// The content shown. `slide`: of slides. `refused`: why the last one that was asked for is not
// shown.
Json contentJson(const shm::WallSegment& segment, const shm::WallStats& stats,
                 const shm::WallInteraction& interaction) {
  const auto content = segment.content.read().value_or(shm::WallContent{});
  return {{"index", interaction.content},    {"name", text(content.name)},
          {"kind", text(content.kind)},      {"slide", text(content.slide)},
          {"detail", detailJson(stats)},     {"request", content.finished},
          {"refused", text(content.refused)}};
}

const char* shownName(const shm::WallInteraction& interaction) {
  if (interaction.shown == shm::WallInteraction::kBlank) return "blank";
  return interaction.shown == shm::WallInteraction::kFrozen ? "frozen" : "picture";
}

const char* playlistName(const shm::WallInteraction& interaction) {
  if (interaction.playlist == shm::WallInteraction::kPlaylistRunning) return "running";
  return interaction.playlist == shm::WallInteraction::kPlaylistWaiting ? "waiting" : "off";
}

// Null if it is not going to happen.
Json secondsUntil(float in_s) {
  if (in_s < 0) return nullptr;
  return round3(in_s);
}

// The actions that have begun at least once; "held": names of those that are held.
Json actionsJson(const shm::ActionState& state) {
  Json begun = Json::object(), held = Json::array();
  for (std::size_t i = 0; i < kActions.size(); ++i) {
    if (state.begun[i] > 0) begun[kActions[i]] = state.begun[i];
    if (state.held[i] != 0) held.push_back(kActions[i]);
  }
  return {{"changed_ns", state.changed_ns},
          {"generation", state.generation},
          {"begun", std::move(begun)},
          {"held", std::move(held)}};
}

Json rendererJson(const RendererState& r) {
  return {{"name", r.name},
          {"vendor", r.vendor},
          {"driver", r.driver},
          {"library", r.library},
          {"software", r.software},
          {"node", r.node},
          {"pci", r.pci},
          {"contexts", r.contexts},
          {"read_back", r.read_back},
          {"correction", r.correction},
          {"correction_fault", r.correction_fault}};
}

}  // namespace

std::string wallStatus(const shm::WallSegment& segment, Timestamp now,
                       const std::vector<net::ServerHealth>& servers,
                       const shm::DeviceSlots* remote, const RendererState* renderer) {
  const auto s = segment.stats.read().value_or(shm::WallStats{});
  const auto interaction = segment.interaction.read().value_or(shm::WallInteraction{});
  const auto idle = segment.idle.read().value_or(shm::WallIdle{0, -1, -1, -1, 0});
  Json json = {{"role", "wall"},
               {"pid", segment.header.pid},
               {"time_utc", timeUtc(segment.header, now)},
               {"uptime_s", ageSeconds(segment.header.started_ns, now)},
               {"rate_asked", round3(s.rate_asked_hz)},
               {"rate_held", round3(s.rate_held_hz)},
               {"late_percent", round3(100 * s.late_share)},
               {"late_percent_1s", round3(100 * s.late_share_1s)},
               {"late_percent_1min", round3(100 * s.late_share_1min)},
               {"longest_late", s.longest_late},
               {"frames", s.frames},
               {"detail", detailJson(s)},
               {"moving", s.moving != 0},
               {"full_detail", s.full_detail != 0},
               {"mode", text(s.mode)},
               {"grabbed", s.grabbed != 0},
               {"pointer", pointerJson(interaction)},
               {"content", contentJson(segment, s, interaction)},
               {"snapshots", interaction.snapshots},
               {"shown", shownName(interaction)},
               {"light", round3(interaction.light)},
               {"playlist", playlistName(interaction)},
               {"playlist_in_s", secondsUntil(idle.playlist_in_s)},
               {"next_in_s", secondsUntil(idle.next_in_s)},
               {"dim_in_s", secondsUntil(idle.dim_in_s)},
               {"testcard", idle.testcard != 0},
               {"notice", text(segment.notice.read().value_or(shm::WallNotice{}).text)},
               {"work_ms", round3(s.work_ms)},
               {"work_median_ms", round3(s.work_median_ms)},
               {"utilisation", round3(s.utilisation)},
               {"head_room", round3(s.head_room)},
               {"cost_fixed_ms", round3(s.cost_fixed_ms)},
               {"cost_coefficient_us", round3(s.cost_coefficient_us)},
               {"cost_exponent", round3(s.cost_exponent)},
               {"rate_now", round3(s.rate_now_hz)},
               {"rate_divisor", s.rate_divisor},
               {"scale_divisor", s.scale_divisor},
               {"operator_coarser", s.operator_coarser != 0},
               {"ladder_steps", s.ladder_steps},
               {"budget", s.budget},
               {"oscillation", round3(s.oscillation)},
               {"settle_frames", s.settle_frames},
               {"still_to_first_s", round3(s.still_to_first_s)},
               {"work_histogram", s.work_histogram},
               {"input_age_ms", round3(s.input_age_ms)},
               {"still_to_full_s", round3(s.still_to_full_s)},
               {"resumed", s.resumed},
               {"resumed_late", s.resumed_late},
               {"stale_s", ageSeconds(s.updated_ns, now)},
               {"outputs", outputsJson(segment)},
               {"servers", serversJson(servers)}};
  // Of a model, under the name that people look for.
  if (text(s.cost_unit) == kTriangles) json["triangles"] = s.cost;
  if (renderer) json["renderer"] = rendererJson(*renderer);
  if (remote) {
    json["posture"] = postureName(*remote);
    json["devices"] = devicesJson(*remote, now);
  }
  return dump(json);
}

std::string addShownFolder(const std::string& document, const ShownFolderState& folder) {
  return addMember(
      document, "shown_folder",
      {{"path", folder.path}, {"limit_bytes", folder.limit_bytes}, {"fault", folder.fault}});
}

namespace {

Json postureSampleJson(const PostureSample& p) {
  return {
      {"received_ns", p.received_ns}, {"since_ns", p.since_ns},
      {"counter", p.counter},         {"code", p.code},
      {"name", text(p.name)},         {"activation", list(std::span<const float>(p.activation))}};
}

Json gloveJson(const GloveSample& g) {
  return {{"received_ns", g.received_ns},
          {"counter", g.counter},
          {"flags", g.flags},
          {"sensors", g.sensors},
          {"raw", integers(std::span<const std::uint8_t>(g.raw))},
          {"angle_rad", list(std::span<const float>(g.angle_rad))}};
}

Json stationJson(const TrackerSample& t) {
  return {{"station", t.station},
          {"received_ns", t.received_ns},
          {"counter", t.counter},
          {"error", std::string(1, t.error)},
          {"position_m", list(std::span<const float>(t.position_m))},
          {"orientation_wxyz", list(std::span<const float>(t.orientation_wxyz))}};
}

Json ballJson(const BallSample& b) {
  return {{"received_ns", b.received_ns},
          {"counter", b.counter},
          {"buttons", b.buttons},
          {"period_us", b.period_us},
          {"raw", integers(std::span<const std::int16_t>(b.raw))},
          {"translation", list(std::span<const float>(b.translation))},
          {"rotation", list(std::span<const float>(b.rotation))}};
}

Json touchJson(const TouchSample& t) {
  Json fingers = Json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(t.fingers, kFingers); ++i)
    fingers.push_back({{"id", t.id[i]}, {"position", list(std::span<const float>(t.position[i]))}});
  return {{"received_ns", t.received_ns},
          {"counter", t.counter},
          {"fingers", std::move(fingers)},
          {"aspect", round3(static_cast<double>(t.aspect))}};
}

// Each device's newest samples under its name; of the first glove the posture also beside it.
void addSamples(const shm::DeviceSlots& devices, Json& json) {
  for (const auto& glove : devices.gloves) {
    const auto p = glove.posture->newest();
    if (p && &glove == &devices.gloves.front()) json["posture"] = postureSampleJson(*p);
    if (const auto g = glove.samples->newest()) json[glove.name] = gloveJson(*g);
    if (p && json.contains(glove.name)) json[glove.name]["posture"] = postureSampleJson(*p);
  }
  for (const auto& tracker : devices.trackers) {
    Json stations = Json::array();
    for (const auto* channel : tracker.stations) {
      if (const auto t = channel->newest()) stations.push_back(stationJson(*t));
    }
    if (!stations.empty()) json[tracker.name] = std::move(stations);
  }
  for (const auto& ball : devices.balls) {
    if (const auto b = ball.samples->newest()) json[ball.name] = ballJson(*b);
  }
  for (const auto& touch : devices.touches) {
    if (const auto t = touch.samples->newest()) json[touch.name] = touchJson(*t);
  }
  for (const auto& hand : devices.hands) {
    if (const auto h = hand.samples->newest()) json[hand.name] = handJson(*h);
  }
}

}  // namespace

std::string newestSamples(const shm::DeviceSlots& devices, Timestamp now) {
  Json json = {{"now_ns", toNanoseconds(now)}, {"time_utc", timeUtc(*devices.header, now)}};
  addSamples(devices, json);
  for (const auto& [source, slot] : devices.actions) {
    if (const auto a = slot->read()) json["actions"][source] = actionsJson(*a);
  }
  json["health"] = briefHealth(devices);
  return dump(json);
}

std::string devicesMetrics(const shm::DeviceSlots& devices) {
  Json json = {{"role", "devices"}};
  for (const auto& [name, slot] : devices.health) {
    const auto h = slot->read();
    if (!h) continue;
    json[name + "_ok"] = h->state == HealthState::kOk ? 1 : 0;
    json[name + "_samples_total"] = h->samples;
    json[name + "_reconnects_total"] = h->reconnects;
    json[name + "_bad_packets_total"] = h->bad_packets;
    json[name + "_bad_bytes_total"] = h->bad_bytes;
    json[name + "_rate_hz"] = round3(h->rate_hz);
  }
  return dump(json);
}

namespace {

// How many outputs were found to show what was meant, and how many something else.
void addPictureCounts(const shm::WallSegment& segment, Json& json) {
  int right = 0, wrong = 0;
  if (const auto all = segment.outputs.read()) {
    for (const shm::OutputStats& o : std::span(all->outputs).first(all->count)) {
      right += o.picture == 1 ? 1 : 0;
      wrong += o.picture > 1 && o.picture < std::size(kPictures) ? 1 : 0;
    }
  }
  json["outputs_right"] = right;
  json["outputs_wrong"] = wrong;
}

}  // namespace

std::string wallMetrics(const shm::WallSegment& segment) {
  const auto s = segment.stats.read().value_or(shm::WallStats{});
  Json json = {{"role", "wall"},
               {"frames_total", s.frames},
               {"deadlines_total", s.deadlines},
               {"late_total", s.late},
               {"longest_late", s.longest_late},
               {"detail_cost", s.cost},
               {"rate_held_hz", round3(s.rate_held_hz)},
               {"work_ms", round3(s.work_ms)},
               {"utilisation", round3(s.utilisation)},
               {"late_share", round3(s.late_share)},
               {"late_share_1s", round3(s.late_share_1s)},
               {"late_share_1min", round3(s.late_share_1min)},
               {"settle_frames", s.settle_frames},
               {"oscillation", round3(s.oscillation)},
               {"detail_step", s.detail_step},
               {"budget", s.budget},
               {"rate_now_hz", round3(s.rate_now_hz)},
               {"rate_divisor", s.rate_divisor},
               {"scale_divisor", s.scale_divisor},
               {"operator_coarser", s.operator_coarser},
               {"ladder_steps_total", s.ladder_steps},
               {"head_room", round3(s.head_room)},
               {"cost_fixed_ms", round3(s.cost_fixed_ms)},
               {"cost_coefficient_us", round3(s.cost_coefficient_us)},
               {"cost_exponent", round3(s.cost_exponent)}};
  addPictureCounts(segment, json);
  // work_sixteenths_N: frames whose work took between (N - 1)/16 and N/16 of the period.
  if (text(s.cost_unit) == kTriangles) json["triangles"] = s.cost;
  for (std::size_t i = 0; i < std::size(s.work_histogram); ++i)
    json["work_sixteenths_" + std::to_string(i + 1) + "_total"] = s.work_histogram[i];
  return dump(json);
}

std::string textList(const std::vector<std::string>& texts) { return dump(Json(texts)); }

std::string event(std::string_view kind, std::string_view what, Timestamp now) {
  return dump({{"now_ns", toNanoseconds(now)},
               {"time_utc", isoUtc(toNanoseconds(now) + realtimeOffset().count())},
               {"kind", std::string(kind)},
               {"what", std::string(what)}});
}

}  // namespace merlin::status
