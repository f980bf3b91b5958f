#include "daemon/cli/wall/status_text.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "daemon/status/client.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr Duration kStatusPatience = std::chrono::seconds(5);

// Returns the unit of the detail of a frame, such as "triangles".
std::string costUnit(const Json& s) { return s.value("detail", Json::object()).value("unit", ""); }

std::uint64_t detailCost(const Json& s) {
  return s.value("detail", Json::object()).value("cost", std::uint64_t{0});
}

// Returns the part of a device's line after its health.
std::string deviceDetail(const Json& d) {
  std::string reason = d.value("reason", "");
  if (d.value("health", "") != "ok") return reason;
  return fmt::format("{:5.1f} Hz  {}{}", d.value("rate_hz", 0.0), d.value("identity", ""),
                     reason.empty() ? "" : "; " + reason);
}

bool isFailed(const Json& service) {
  return service.is_object() && service.value("health", "") != "ok";
}

// Returns the concatenated texts about all failed services. `format`: format of each text, with the
// arguments name, health and reason.
std::string failedServices(const Json& s, const char* format) {
  const Json services = s.value("services", Json::object());
  std::string text;
  for (const auto& [name, service] : services.items()) {
    if (isFailed(service))
      text += fmt::format(fmt::runtime(format), name, service.value("health", ""),
                          service.value("reason", ""));
  }
  return text;
}

std::string pictureWord(const Json& s) {
  const std::string shown = s.value("shown", "picture");
  if (shown != "picture") return shown;
  if (s.value("moving", false)) return s.value("grabbed", false) ? "grabbed" : "moving";
  return s.value("full_detail", false) ? "still, full detail" : "still, refining";
}

// Returns how the wall's present state differs from its configuration: degradations under load,
// dimming, and a number of triangles set by hand. Empty if there is no difference.
std::string givenWay(const Json& s) {
  std::string text;
  if (s.value("rate_divisor", 1) > 1)
    text += fmt::format("; frame rate reduced to {:.3g} Hz", s.value("rate_now", 0.0));
  if (s.value("scale_divisor", 1) > 1) text += "; tiles drawn at half size";
  if (s.value("operator_coarser", false)) text += "; operator's view coarser";
  if (s.value("shown", "") == "picture" && s.value("light", 1.0) < 1)
    text += fmt::format("; dimmed to {:.0f} % of its light", 100 * s.value("light", 1.0));
  const int held = s.value("detail", Json::object()).value("held_cost", 0);
  if (held > 0) text += fmt::format("; {} {} set by hand", held, costUnit(s));
  return text;
}

// Returns `what` followed by the time s[key] until it is due, as in ", the next one in 12 s"; empty
// if nothing is due.
std::string dueIn(const Json& s, const char* key, const char* what) {
  const auto due = s.find(key);
  if (due == s.end() || !due->is_number()) return {};
  return fmt::format("{} in {:.0f} s", what, due->get<double>());
}

std::string playlistWords(const Json& s) {
  const std::string state = s.value("playlist", "");
  if (state == "running") return "; the playlist runs" + dueIn(s, "next_in_s", ", the next one");
  if (state == "off") return "; the playlist is off";
  if (state != "waiting") return {};
  const std::string begins = dueIn(s, "playlist_in_s", "; the playlist begins");
  return begins.empty() ? "; the playlist waits" : begins;
}

// Returns the line about the current content and about the playlist.
std::string contentLine(const Json& s) {
  const Json content = s.value("content", Json::object());
  const std::string slide = content.value("slide", "");
  return fmt::format("content  {} ({}{}){}{}\n", content.value("name", ""),
                     content.value("kind", ""), slide.empty() ? "" : ": " + slide, playlistWords(s),
                     s.value("testcard", false) ? "; a test card covers it" : "");
}

std::string paceLines(const Json& s) {
  std::string text =
      fmt::format("cost     {:.1f} ms + {:.3f} us x {}^{:.2f}; next frame {} {}{}\n",
                  s.value("cost_fixed_ms", 0.0), s.value("cost_coefficient_us", 0.0), costUnit(s),
                  s.value("cost_exponent", 0.0), s.value("budget", 0), costUnit(s), givenWay(s));
  text += fmt::format(
      "steps    frame rate settled {} frames after the last load change; detail oscillates by "
      "{:.1f} "
      "%; first refinement {:.2f} s after standstill, full detail after {:.2f} s\n",
      s.value("settle_frames", 0), 100 * s.value("oscillation", 0.0),
      s.value("still_to_first_s", 0.0), s.value("still_to_full_s", 0.0));
  return text + histogramChart(s.value("work_histogram", std::vector<std::uint32_t>{}));
}

std::string rendererLine(const Json& s) {
  if (!s.contains("renderer")) return {};
  const Json& r = s["renderer"];
  const std::string fault = r.value("correction_fault", "");
  const std::string copied = r.value("scan_out_fault", "");
  return fmt::format("drawn by {} ({}; {}), {}, {} context{}, {} read-back; corrections {}{}{}{}\n",
                     r.value("name", ""), r.value("vendor", ""), r.value("driver", ""),
                     r.value("software", true) ? "software" : "hardware", r.value("contexts", 1),
                     r.value("contexts", 1) > 1 ? "s" : "", r.value("read_back", ""),
                     r.value("correction", "") == "gpu" ? "by a shader" : "on the CPU",
                     fault.empty() ? "" : ": " + fault,
                     r.value("scan_out", "") == "drawn" ? ", into the displays' memory" : "",
                     copied.empty() ? "" : "; copied to a display: " + copied);
}

std::string outputDetail(const Json& output) {
  if (output.value("health", "") == "failed") return output.value("reason", "");
  const std::string wrong = output.value("picture_reason", "");
  if (!wrong.empty()) return wrong;
  return fmt::format("{:.1f} Hz shown, {:.2f} % late", output.value("shown_hz", 0.0),
                     output.value("late_percent", 0.0));
}

std::string outputLines(const Json& s) {
  std::string text;
  if (!s.contains("outputs")) return text;
  for (const auto& [name, output] : s["outputs"].items()) {
    const bool wrong = !output.value("picture_reason", std::string()).empty();
    const std::string state = wrong ? "wrong" : output.value("health", "");
    text += fmt::format("output   {:14} {:8} {}\n", name, state, outputDetail(output));
  }
  return text;
}

// Sets "services" to the services of all roles. Both roles may have a service of the same name; a
// failed one takes precedence, so that it is not hidden.
void mergeServices(Json& both) {
  Json merged = Json::object();
  for (const Json& role : both["roles"]) {
    for (const auto& [name, service] : role["services"].items()) {
      if (isFailed(service) || !merged.contains(name)) merged[name] = service;
    }
  }
  both.erase("services");
  if (!merged.empty()) both["services"] = std::move(merged);
}

// Returns a line for each role that was killed, has crashed or hangs.
std::string lostLines(const Json& s) {
  const Json lost = s.value("lost_roles", Json::object());
  std::string text;
  for (const auto& [role, entry] : lost.items())
    text += fmt::format("{:8} {}\n", role, entry.value("reason", ""));
  return text;
}

}  // namespace

// Each line combines two buckets. Empty lines before the first and after the last bucket with
// frames are left out.
std::string histogramChart(const std::vector<std::uint32_t>& buckets) {
  constexpr double kWidth = 40;
  std::vector<std::uint64_t> eighths((buckets.size() + 1) / 2);
  for (std::size_t i = 0; i < buckets.size(); ++i) eighths[i / 2] += buckets[i];
  const auto used = [](std::uint64_t n) { return n > 0; };
  const auto first = std::find_if(eighths.begin(), eighths.end(), used);
  if (first == eighths.end()) return {};
  const auto last = std::find_if(eighths.rbegin(), eighths.rend(), used).base();
  const auto most = static_cast<double>(*std::max_element(first, last));
  const auto all = static_cast<double>(std::accumulate(first, last, std::uint64_t{0}));
  std::string text = "frames by work, as a share of the period\n";
  for (auto e = first; e != last; ++e) {
    const auto percent = 12.5 * static_cast<double>(e - eighths.begin());
    const auto n = static_cast<double>(*e);
    const bool open = e + 1 == eighths.end();
    text += fmt::format("  {:5.1f} - {:>5} %  {:<40} {:5.1f} %\n", percent,
                        open ? "more" : fmt::format("{:.1f}", percent + 12.5),
                        std::string(static_cast<std::size_t>(std::ceil(kWidth * n / most)), '#'),
                        100 * n / all);
  }
  return text;
}

void addLostRoles(const std::string& instance, Json& both) {
  for (const LostRole& lost : lostRoles(instance))
    both["lost_roles"][lost.role] = {{"silent_s", toSeconds(lost.silent)}, {"reason", lost.what()}};
}

void mergeStatus(Json& both, const std::string& document) {
  auto json = Json::parse(document, nullptr, false);
  if (!json.is_object()) return;
  const std::string role = json.value("role", "");
  Json& common = both["roles"][role];
  for (const char* key : {"pid", "uptime_s"}) {
    if (json.contains(key)) common[key] = json[key];
    json.erase(key);
  }
  json.erase("role");
  common["services"] = Json::object();
  if (json.contains("services")) common["services"] = json["services"];
  json.erase("services");
  both.update(json, true);  // merges recursively, because both roles have "servers"
  mergeServices(both);
}

Result<Json> askStatus(const std::string& instance) {
  DaemonAddress daemon;
  daemon.instance = instance;
  return askStatus(daemon);
}

Result<Json> askStatus(const DaemonAddress& daemon) {
  const auto roles = findRoles(daemon);
  if (!roles) return roles.error();
  Json both = Json::object();
  for (const FoundRole& role : *roles) {
    const auto allowed = checkMayAsk(role.endpoints.command);
    if (!allowed) return allowed.error();
    const auto answer = status::ask(role.commands(), "status", kStatusPatience);
    if (!answer) return answer.error();
    mergeStatus(both, *answer);
  }
  if (!daemon.isRemote()) addLostRoles(daemon.instance, both);
  return both;
}

namespace {

// Returns a line for each server that has failed or has refused a connection.
std::string serverLines(const Json& s) {
  std::string text;
  if (!s.contains("servers")) return text;
  for (const auto& [name, server] : s["servers"].items()) {
    const std::string reason = server.value("reason", ""), last = server.value("last", "");
    if (!reason.empty())
      text += fmt::format("{:8} failed   {}\n", name, reason);
    else if (!last.empty())
      text += fmt::format("{:8} ok       {} connected; last refused: {}\n", name,
                          server.value("connections", 0), last);
  }
  return text;
}

// Returns a line for each content that cannot be shown.
std::string missingLines(const Json& s) {
  const Json missing = s.value("missing_contents", Json::object());
  std::string text;
  for (const auto& [name, why] : missing.items())
    text += fmt::format("left out {}: {}\n", name, why.get<std::string>());
  return text;
}

// Returns a line with the last gesture of each hand whose gestures are recognised.
std::string gestureLines(const Json& s) {
  std::string text;
  if (!s.contains("gestures")) return text;
  for (const auto& [hand, g] : s["gestures"].items()) {
    if (g.is_null()) continue;
    const int counter = g.value("counter", 0);
    text += counter == 0 ? fmt::format("gesture  {}: none so far\n", hand)
                         : fmt::format("gesture  {}: {}, {:.0f} s ago, {} so far\n", hand,
                                       g.value("name", ""), g.value("age_s", 0.0), counter);
  }
  return text;
}

// Returns a line for each projector.
std::string projectorLines(const Json& s) {
  std::string text;
  if (!s.contains("projectors")) return text;
  for (const auto& [name, p] : s["projectors"].items()) {
    const std::string reason = p.value("reason", ""), wanted = p.value("wanted", "");
    std::string detail = p.value("identity", "");
    for (const int hours : p.value("lamp_hours", std::vector<int>{}))
      detail += fmt::format("{}lamp {} h", detail.empty() ? "" : ", ", hours);
    if (!wanted.empty()) detail += fmt::format("{}to be {}", detail.empty() ? "" : ", ", wanted);
    if (!reason.empty()) detail += (detail.empty() ? "" : "; ") + reason;
    text += fmt::format("projector {:13} {:8} {:12} {}\n", name, p.value("power", ""),
                        p.value("health", ""), detail);
  }
  return text;
}

std::string frameLines(const Json& s) {
  if (s.value("frames", 0) == 0) return "wall     has not shown its first frame yet\n";
  std::string text = fmt::format("wall     {:.1f} of {:.0f} Hz, {} {}, {} (ball mode: {})\n",
                                 s.value("rate_held", 0.0), s.value("rate_asked", 0.0),
                                 detailCost(s), costUnit(s), pictureWord(s), s.value("mode", ""));
  text += contentLine(s);
  text += fmt::format(
      "frames   {} drawn; {:.2f} % of those due while moving were late (last minute {:.2f} %), at "
      "most {} in a row\n",
      s.value("frames", 0), s.value("late_percent", 0.0), s.value("late_percent_1min", 0.0),
      s.value("longest_late", 0));
  text += fmt::format(
      "work     {:.1f} ms per frame (median of the last second), {:.0f} % of the period, head "
      "room {:.0f} %\n",
      s.value("work_median_ms", 0.0), 100 * s.value("utilisation", 0.0),
      100 * s.value("head_room", 0.0));
  return text + paceLines(s);
}

}  // namespace

std::string statusTable(const Json& s) {
  std::string text = lostLines(s);
  if (s.contains("rate_asked"))
    text += frameLines(s) + rendererLine(s) + outputLines(s) + missingLines(s);
  const std::string servers = serverLines(s) + failedServices(s, "service  {:14} {:8} {}\n");
  if (!s.contains("devices")) return text + servers;
  const std::string posture = s.value("posture", "");
  text += fmt::format("posture  {}\n", posture.empty() ? "-" : posture) + gestureLines(s);
  for (const auto& [name, device] : s["devices"].items()) {
    text += fmt::format("{:16} {:8} {}\n", name, device.value("health", ""), deviceDetail(device));
  }
  return text + projectorLines(s) + servers;
}

std::string statusLine(const Json& s) {
  std::string line;
  if (s.contains("rate_asked")) {
    line = fmt::format("{:4.1f} of {:.0f} Hz  {:7} {}  {:5.2f} % late  {:18}",
                       s.value("rate_held", 0.0), s.value("rate_asked", 0.0), detailCost(s),
                       costUnit(s), s.value("late_percent", 0.0), pictureWord(s));
  }
  if (!s.contains("devices")) return line + failedServices(s, "  {} {}: {}");
  const std::string posture = s.value("posture", "");
  line += fmt::format("  posture {:8}", posture.empty() ? "-" : posture);
  for (const auto& [name, device] : s["devices"].items())
    line += fmt::format("  {} {}", name, device.value("health", ""));
  return line + failedServices(s, "  {} {}: {}");
}

}  // namespace merlin::cli
