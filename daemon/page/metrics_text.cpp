#include "daemon/page/metrics_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/json/json_tree.h"

namespace merlin::page {
namespace {

// Description of a metric in a role's document. `name`: its name in the document. `to`: its name in
// /metrics; empty: the same. `scale`: factor that converts the value to the base unit.
struct Described {
  std::string_view name, to, help;
  double scale = 1;
};

constexpr Described kWall[] = {
    {"frames_total", "", "Frames drawn and presented."},
    {"deadlines_total", "", "Deadlines that passed while something moved."},
    {"late_total", "", "Deadlines that were missed while something moved."},
    {"longest_late", "longest_late_frames", "Longest sequence of late frames since the start."},
    {"detail_cost", "", "Cost of the last frame's detail; for a model, its triangles."},
    {"triangles", "", "Triangles of the last frame."},
    {"rate_held_hz", "rate_held_hertz", "Deadlines met in the last second."},
    {"rate_now_hz", "rate_now_hertz", "Desired rate, divided by rate_divisor."},
    {"work_ms", "work_seconds", "Work of the last frame, from its start to its last pixel.", 1e-3},
    {"utilisation", "utilisation_ratio",
     "Mean work of the last second's moving frames, share of the period."},
    {"late_share", "late_ratio", "Share of deadlines that were missed, since the start."},
    {"late_share_1s", "late_ratio_1s", "Share of deadlines missed in the last second."},
    {"late_share_1min", "late_ratio_1min", "Share of deadlines missed in the last minute."},
    {"settle_frames", "", "Last settling: late frames until five in a row were in time."},
    {"oscillation", "oscillation_ratio", "(p95 - p5) / mean of the last 100 moving frames' costs."},
    {"detail_step", "", "Step of the content's detail; 0 is full detail."},
    {"budget", "", "Cost that the next moving frame may have."},
    {"rate_divisor", "", "1; 2 to 4 while even the coarsest detail takes too long."},
    {"scale_divisor", "", "2 while moving tiles are drawn at half size, otherwise 1."},
    {"operator_coarser", "", "1 while the operator's view is coarser to save time."},
    {"ladder_steps_total", "", "Changes of rate_divisor, scale_divisor and operator_coarser."},
    {"head_room", "head_room_ratio", "Time reserve of the governor, share of the period."},
    {"cost_fixed_ms", "cost_fixed_seconds", "Cost model: the part of a frame's work that is fixed.",
     1e-3},
    {"cost_coefficient_us", "cost_coefficient_seconds",
     "Cost model: work for a cost of one, before the exponent.", 1e-6},
    {"cost_exponent", "", "Cost model: exponent of the cost."},
    {"outputs_right", "", "Outputs that were found to show what was meant."},
    {"outputs_wrong", "", "Outputs that were found black, frozen, torn, or with another picture."},
};

// Metrics of a device; in the document, the device's name and _ precede these names.
constexpr Described kDevice[] = {
    {"ok", "", "1 while the device works."},
    {"samples_total", "", "Samples received from the device."},
    {"reconnects_total", "", "Times that the device was connected again."},
    {"bad_packets_total", "", "Packets that could not be read."},
    {"bad_bytes_total", "", "Bytes that belong to no packet."},
    {"rate_hz", "rate_hertz", "Samples in the last second."},
};

constexpr std::string_view kWork = "work_sixteenths_";

struct Family {
  std::string help;
  bool counter = false;
  std::vector<std::pair<std::string, double>> samples;  // labels with their braces, value
};
using Families = std::map<std::string, Family>;

// Returns the name, at most 100 bytes of it, with _ for each character that Prometheus does not
// allow. A first digit needs no change, because merlin_ is put before the name.
std::string validName(std::string_view name) {
  std::string valid(name.substr(0, 100));
  for (char& c : valid) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return valid;
}

std::string labelText(std::string_view value) {
  std::string text;
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    text += c == '\n' ? ' ' : c;
  }
  return text;
}

void addSample(Families& families, const std::string& name, std::string_view help,
               std::pair<std::string, double> sample) {
  Family& family = families["merlin_" + name];
  if (family.help.empty()) family.help = help;
  family.counter = name.ends_with("_total");
  family.samples.push_back(std::move(sample));
}

const Described* describedAs(std::span<const Described> table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &Described::name);
  return found == table.end() ? nullptr : &*found;
}

// Returns the number N of "work_sixteenths_N_total"; nothing for another name.
std::optional<int> sixteenthOf(std::string_view name) {
  if (!name.starts_with(kWork)) return std::nullopt;
  int number = 0;
  const char* const begin = name.data() + kWork.size();
  const auto [end, error] = std::from_chars(begin, name.data() + name.size(), number);
  if (error != std::errc{} || std::string_view(end, name.data() + name.size()) != "_total")
    return std::nullopt;
  return number;
}

// Adds the numbers of frames whose work took at most le periods, a cumulative histogram from which
// Prometheus can compute quantiles.
void addWork(Families& families, const std::map<int, double>& sixteenths) {
  double sum = 0;
  int number = 0;
  for (const auto& [sixteenth, frames] : sixteenths) {
    sum += frames;
    const bool last = ++number == static_cast<int>(sixteenths.size());
    addSample(families, "wall_work_periods_total",
              "Moving frames whose work took at most le periods.",
              {last ? std::string("{le=\"+Inf\"}") : fmt::format("{{le=\"{}\"}}", sixteenth / 16.0),
               sum});
  }
}

// Splits the name of a device's metric: "glove_samples_total" into "glove" and the entry
// "samples_total" of kDevice. Nothing if no entry matches.
std::optional<std::pair<std::string_view, const Described*>> deviceMetric(std::string_view name) {
  for (const Described& metric : kDevice) {
    if (name.size() <= metric.name.size() + 1 || !name.ends_with(metric.name)) continue;
    const std::string_view device = name.substr(0, name.size() - metric.name.size());
    if (device.ends_with('_')) return std::pair(device.substr(0, device.size() - 1), &metric);
  }
  return std::nullopt;
}

void addMetric(Families& families, const std::string& role, std::string_view name, double value) {
  if (role == "devices") {
    if (const auto metric = deviceMetric(name)) {
      const Described& d = *metric->second;
      return addSample(families, "device_" + std::string(d.to.empty() ? d.name : d.to), d.help,
                       {fmt::format("{{device=\"{}\"}}", labelText(metric->first)), value});
    }
  }
  const Described* const d = role == "wall" ? describedAs(kWall, name) : nullptr;
  const std::string_view to = d && !d->to.empty() ? d->to : name;
  addSample(families, fmt::format("{}_{}", validName(role), validName(to)),
            d ? std::string(d->help) : fmt::format("{} of the role {}.", validName(name), role),
            {"", d ? value * d->scale : value});
}

void addRole(Families& families, const RoleMetrics& role) {
  addSample(families, "up", "1 while the role of merlind runs.",
            {fmt::format("{{role=\"{}\"}}", labelText(role.role)), role.running ? 1 : 0});
  if (!role.running || role.document.empty()) return;
  const auto parsed = parseJson(role.document);
  if (!parsed) return;
  std::map<int, double> work;
  for (const JsonNode::Member& member : parsed->members) {
    if (member.value.kind != JsonNode::Kind::kNumber) continue;
    if (const auto sixteenth = sixteenthOf(member.key))
      work[*sixteenth] = member.value.number;
    else
      addMetric(families, role.role, member.key, member.value.number);
  }
  addWork(families, work);
}

void addPage(Families& families, const PageMetrics& page) {
  const auto add = [&](const char* name, const char* help, auto value) {
    addSample(families, name, help, {"", static_cast<double>(value)});
  };
  add("page_connections", "Connections to the page.", page.connections);
  add("page_accepted_total", "Connections that were accepted.", page.accepted);
  add("page_sent_away_total", "Connections that were refused or closed.", page.sent_away);
  add("page_requests_total", "Requests to the page.", page.requests);
  add("page_refused_total", "Requests that were answered by an error.", page.refused);
  add("page_pictures_total", "Pictures that were encoded.", page.pictures);
}

}  // namespace

bool isDescribed(const std::string& role, const std::string& name) {
  if (role == "devices") return deviceMetric(name).has_value();
  return describedAs(kWall, name) || sixteenthOf(name);
}

std::string metricsText(const std::vector<RoleMetrics>& roles, const PageMetrics& page) {
  Families families;
  for (const RoleMetrics& role : roles) addRole(families, role);
  addPage(families, page);
  std::string text;
  for (const auto& [name, family] : families) {
    text += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, family.help,
                        family.counter ? "counter" : "gauge");
    for (const auto& [labels, value] : family.samples)
      text += fmt::format("{}{} {}\n", name, labels, value);
  }
  return text;
}

}  // namespace merlin::page
