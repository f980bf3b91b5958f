#include "daemon/cli/status_text.h"

#include <fmt/format.h>

#include "daemon/cli/roles.h"
#include "daemon/status/client.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr Duration kPatience = std::chrono::seconds(2);

// What a device's line says after its health.
std::string deviceDetail(const Json& d) {
  std::string reason = d.value("reason", "");
  if (d.value("health", "") != "ok") return reason;
  return fmt::format("{:5.1f} Hz  {}{}", d.value("rate_hz", 0.0), d.value("identity", ""),
                     reason.empty() ? "" : "; " + reason);
}

std::string pictureWord(const Json& s) {
  if (s.value("moving", false)) return s.value("grabbed", false) ? "grabbed" : "moving";
  return s.value("full_detail", false) ? "still, full detail" : "still, refining";
}

}  // namespace

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
  both.update(json);
}

Result<Json> askStatus(const std::string& instance) {
  const auto roles = findRoles(instance);
  if (!roles) return roles.error();
  Json both = Json::object();
  for (const FoundRole& role : *roles) {
    const auto answer = status::ask(role.endpoints.command, "status", kPatience);
    if (!answer) return answer.error();
    mergeStatus(both, *answer);
  }
  return both;
}

std::string statusTable(const Json& s) {
  std::string text;
  if (s.contains("rate_asked")) {
    text += fmt::format("wall     {:.1f} of {:.0f} Hz held, {} triangles, {} (ball: {})\n",
                        s.value("rate_held", 0.0), s.value("rate_asked", 0.0),
                        s.value("triangles", 0), pictureWord(s), s.value("mode", ""));
    text += fmt::format(
        "frames   {} drawn; late {:.2f} % of those due while it moved (last minute {:.2f} %), at "
        "most {} in a row\n",
        s.value("frames", 0), s.value("late_percent", 0.0), s.value("late_percent_1min", 0.0),
        s.value("longest_late", 0));
    text += fmt::format(
        "work     {:.1f} ms a frame (median of the last second), {:.0f} % of the period, head room "
        "{:.0f} %\n",
        s.value("work_median_ms", 0.0), 100 * s.value("utilisation", 0.0),
        100 * s.value("head_room", 0.0));
  }
  if (!s.contains("devices")) return text;
  const std::string posture = s.value("posture", "");
  text += fmt::format("posture  {}\n", posture.empty() ? "-" : posture);
  for (const auto& [name, device] : s["devices"].items()) {
    text += fmt::format("{:8} {:8} {}\n", name, device.value("health", ""), deviceDetail(device));
  }
  return text;
}

std::string statusLine(const Json& s) {
  std::string line;
  if (s.contains("rate_asked")) {
    line = fmt::format("{:4.1f} of {:.0f} Hz  {:7} triangles  {:5.2f} % late  {:18}",
                       s.value("rate_held", 0.0), s.value("rate_asked", 0.0),
                       s.value("triangles", 0), s.value("late_percent", 0.0), pictureWord(s));
  }
  if (!s.contains("devices")) return line;
  const std::string posture = s.value("posture", "");
  line += fmt::format("  posture {:8}", posture.empty() ? "-" : posture);
  for (const auto& [name, device] : s["devices"].items())
    line += fmt::format("  {} {}", name, device.value("health", ""));
  return line;
}

}  // namespace merlin::cli
