#include "daemon/status/documents.h"

#include <span>

#include <fmt/format.h>

#include "daemon/base/commands.h"
#include "daemon/status/add_member.h"
#include "daemon/status/document_parts.h"

namespace merlin::status {
namespace {

// Returns the place that a hand points at; null while no hand points. Its "pixel" is null if no
// wall tile shows that place.
OrderedJson pointerJson(const shm::WallInteraction& h) {
  if (h.pointing == shm::WallInteraction::kNone) return nullptr;
  OrderedJson pixel = nullptr;
  if (h.pixel[0] >= 0) pixel = integers(std::span<const std::int32_t>(h.pixel));
  return {{"at", h.pointing == shm::WallInteraction::kAtModel ? "model" : "wall"},
          {"pixel", std::move(pixel)},
          {"at_model_m", list(std::span<const float>(h.at_model_m))}};
}

double ageSeconds(std::int64_t then_ns, Timestamp now) {
  return round3(toSeconds(now - fromNanoseconds(then_ns)));
}

OrderedJson deviceJson(const DeviceHealth& h, Timestamp now) {
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

// Returns the current posture of a glove (after the minimum hold time), its margin, and as "seen"
// the posture of the newest sample; null before there are any.
OrderedJson postureJson(const shm::DeviceSlots::Glove& glove, Timestamp now) {
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

// Returns the servers for other programs, with their counters of refused and closed connections.
OrderedJson serversJson(const std::vector<net::ServerHealth>& servers) {
  OrderedJson all = OrderedJson::object();
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

// Returns the posture of the first glove that shows one.
std::string postureName(const shm::DeviceSlots& devices) {
  for (const auto& glove : devices.gloves) {
    if (std::string name = postureName(glove); !name.empty()) return name;
  }
  return "";
}

OrderedJson posturesJson(const shm::DeviceSlots& devices, Timestamp now) {
  OrderedJson all = OrderedJson::object();
  for (const auto& glove : devices.gloves) all[glove.name] = postureJson(glove, now);
  return all;
}

// Returns the last gesture of a hand; null if the hand has had no gesture recognition since the
// start.
OrderedJson gestureJson(const shm::DeviceSlots::Hand& hand, Timestamp now) {
  const auto g = hand.gesture->read();
  if (!g) return nullptr;
  OrderedJson age_s = nullptr;
  if (g->counter > 0) age_s = ageSeconds(g->received_ns, now);
  return {{"name", text(g->name)},
          {"counter", g->counter},
          {"age_s", std::move(age_s)},
          {"certainty", round3(static_cast<double>(g->certainty))},
          {"passed_over", g->passed_over}};
}

OrderedJson gesturesJson(const shm::DeviceSlots& devices, Timestamp now) {
  OrderedJson all = OrderedJson::object();
  for (const auto& hand : devices.hands) all[hand.name] = gestureJson(hand, now);
  return all;
}

OrderedJson devicesJson(const shm::DeviceSlots& devices, Timestamp now) {
  OrderedJson all = OrderedJson::object();
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
               {"posture_detail", devices.gloves.empty() ? OrderedJson(nullptr)
                                                         : postureJson(devices.gloves[0], now)},
               {"postures", posturesJson(devices, now)},
               {"gestures", gesturesJson(devices, now)},
               {"devices", devicesJson(devices, now)},
               {"servers", serversJson(servers)}});
}

namespace {

// Names of the values of shm::OutputStats::picture, in their order.
constexpr const char* kPictures[] = {"unchecked", "right", "black", "frozen", "torn", "foreign"};

const char* pictureName(const shm::OutputStats& o) {
  return kPictures[o.picture < std::size(kPictures) ? o.picture : 0];
}

OrderedJson outputsJson(const shm::WallSegment& segment) {
  OrderedJson json = OrderedJson::object();
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

OrderedJson detailJson(const shm::WallStats& s) {
  return {{"step", s.detail_step},    {"steps", s.detail_steps},    {"cost", s.cost},
          {"full_cost", s.full_cost}, {"least_cost", s.least_cost}, {"held_cost", s.held_cost},
          {"unit", text(s.cost_unit)}};
}

// Returns the content that is shown. "slide" is empty except for slides. "refused" says why the
// last requested content is not shown.
OrderedJson contentJson(const shm::WallSegment& segment, const shm::WallStats& stats,
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

// Returns a time in seconds, rounded; null if it is negative, which means that the event is not
// going to happen.
OrderedJson secondsUntil(float in_s) {
  if (in_s < 0) return nullptr;
  return round3(in_s);
}

OrderedJson rendererJson(const RendererState& r) {
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
          {"correction_fault", r.correction_fault},
          {"scan_out", r.scan_out},
          {"scan_out_fault", r.scan_out_fault}};
}

}  // namespace

std::string wallStatus(const shm::WallSegment& segment, Timestamp now,
                       const std::vector<net::ServerHealth>& servers,
                       const shm::DeviceSlots* remote, const RendererState* renderer) {
  const auto s = segment.stats.read().value_or(shm::WallStats{});
  const auto interaction = segment.interaction.read().value_or(shm::WallInteraction{});
  const auto idle = segment.idle.read().value_or(shm::WallIdle{0, -1, -1, -1, 0});
  OrderedJson json = {{"role", "wall"},
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
  // The cost of a model is also given as "triangles", the name that people look for.
  if (text(s.cost_unit) == kTriangles) json["triangles"] = s.cost;
  if (renderer) json["renderer"] = rendererJson(*renderer);
  if (remote) {
    json["posture"] = postureName(*remote);
    json["devices"] = devicesJson(*remote, now);
  }
  return dump(json);
}

std::string addShownFolder(const std::string& document, const ShownFolderState& folder) {
  return addMember(document, "shown_folder",
                   {{"path", folder.path},
                    {"limit_bytes", folder.limit_bytes},
                    {"fault", folder.fault},
                    {"names", folder.names}});
}

std::string addMissingContents(const std::string& document,
                               const std::vector<std::pair<std::string, std::string>>& missing) {
  OrderedJson reasons = OrderedJson::object();
  for (const auto& [name, why] : missing) reasons[name] = why;
  return addMember(document, "missing_contents", reasons);
}

std::string devicesMetrics(const shm::DeviceSlots& devices) {
  OrderedJson json = {{"role", "devices"}};
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

// Adds how many outputs were found to show the right picture, and how many a wrong one.
void addPictureCounts(const shm::WallSegment& segment, OrderedJson& json) {
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
  OrderedJson json = {{"role", "wall"},
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

std::string textList(const std::vector<std::string>& texts) { return dump(OrderedJson(texts)); }

std::string event(std::string_view kind, const Event& event, Timestamp now) {
  return dump({{"now_ns", toNanoseconds(now)},
               {"time_utc", isoUtc(toNanoseconds(now) + realtimeOffset().count())},
               {"kind", std::string(kind)},
               {"severity", std::string(nameOf(event.severity))},
               {"what", event.what}});
}

}  // namespace merlin::status
