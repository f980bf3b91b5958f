#include "daemon/cli/watch/watch_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostChartRows = 8, kLeastChartRows = 3, kLeastEvents = 3;
constexpr int kNameColumns = 16;

struct Span {
  std::string text;
  CellStyle style = CellStyle::kPlain;
};
using Row = std::vector<Span>;

std::optional<double> number(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string text(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool flag(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

// Returns the member `key` if it is an object, otherwise an empty object.
const Json& object(const Json& json, const char* key) {
  static const Json kNone = Json::object();
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? *found : kNone;
}

std::string figure(std::optional<double> value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

CellStyle styleOf(std::string_view health) {
  if (health == "ok") return CellStyle::kGood;
  if (health == "failed" || health == "stale") return CellStyle::kBad;
  return CellStyle::kWarning;
}

Row labelled(const char* label, std::string rest, CellStyle style = CellStyle::kPlain) {
  return {{fmt::format("{:10}", label), CellStyle::kDim}, {std::move(rest), style}};
}

std::string motionOf(const Json& s) {
  const std::string shown = text(s, "shown");
  if (!shown.empty() && shown != "picture") return shown;
  if (flag(s, "moving")) return flag(s, "grabbed") ? "grabbed" : "moving";
  return flag(s, "full_detail") ? "still, full detail" : "still, refining";
}

Row detailRow(const Json& s) {
  const Json& d = object(s, "detail");
  std::string rest = fmt::format("{} {}, step {} of {}; full {}", figure(number(d, "cost"), 0),
                                 text(d, "unit"), figure(number(d, "step"), 0),
                                 figure(number(d, "steps"), 0), figure(number(d, "full_cost"), 0));
  const auto held = number(d, "held_cost");
  if (held && *held > 0) rest += fmt::format("; {:.0f} set by hand", *held);
  return labelled("detail", rest);
}

Row contentRow(const Json& s) {
  const Json& c = object(s, "content");
  const std::string name = text(c, "name"), kind = text(c, "kind"), slide = text(c, "slide");
  std::string rest = name.empty() ? "-" : name;
  if (!kind.empty()) rest += fmt::format(" ({})", kind);
  if (!slide.empty()) rest += ": " + slide;
  const std::string refused = text(c, "refused");
  if (!refused.empty()) rest += "; refused: " + refused;
  return labelled("content", rest);
}

// Returns the style for late frames. Only those of the last second count, so that the colour
// appears only while they happen.
CellStyle lateStyle(const Json& s) {
  const double now = number(s, "late_percent_1s").value_or(0);
  return now > 10 ? CellStyle::kBad : now > 0 ? CellStyle::kWarning : CellStyle::kGood;
}

std::vector<Row> wallRows(const Json& s) {
  if (!s.contains("rate_asked")) return {};
  std::vector<Row> rows;
  rows.push_back(labelled("rate", fmt::format("{} of {} Hz, {}", figure(number(s, "rate_held"), 1),
                                              figure(number(s, "rate_asked"), 0), motionOf(s))));
  const auto divisor = number(s, "rate_divisor");
  if (divisor && *divisor > 1) {
    rows.back().push_back(
        {fmt::format("; reduced to {} Hz", figure(number(s, "rate_now"), 1)), CellStyle::kWarning});
  }
  rows.push_back(labelled(
      "late",
      fmt::format("{} % (second), {} % (minute), {} % (all); at most {} in a row",
                  figure(number(s, "late_percent_1s"), 2),
                  figure(number(s, "late_percent_1min"), 2), figure(number(s, "late_percent"), 2),
                  figure(number(s, "longest_late"), 0)),
      lateStyle(s)));
  const auto used = number(s, "utilisation");
  rows.push_back(
      labelled("frame", fmt::format("{} ms (median of the last second), {} % of the period",
                                    figure(number(s, "work_median_ms"), 1),
                                    figure(used ? std::optional(100 * *used) : std::nullopt, 0))));
  rows.push_back(detailRow(s));
  rows.push_back(contentRow(s));
  for (const auto& [name, why] : object(s, "missing_contents").items()) {
    if (why.is_string()) rows.push_back(labelled("left out", name + ": " + why.get<std::string>()));
  }
  return rows;
}

Row healthRow(const std::string& name, const std::string& health, const std::string& rate,
              const std::string& rest) {
  return {{fmt::format("  {:{}} ", name, kNameColumns)},
          {fmt::format("{:9}", health.empty() ? "-" : health), styleOf(health)},
          {fmt::format("{:>9}  ", rate)},
          {rest}};
}

// Returns a heading and a row for each member of the object s[key], such as the devices; no rows if
// it has no members.
template <typename MakeRow>
std::vector<Row> table(const Json& s, const char* key, const char* heading, MakeRow row) {
  std::vector<Row> rows;
  const Json& all = object(s, key);
  if (all.empty()) return rows;
  rows.push_back({});
  rows.push_back({{heading, CellStyle::kHeading}});
  for (const auto& [name, one] : all.items()) {
    if (one.is_object()) rows.push_back(row(name, one));
  }
  return rows;
}

// Returns a row for each role that was killed, has crashed or hangs; these are shown above all
// other rows.
std::vector<Row> lostRows(const Json& s) {
  std::vector<Row> rows;
  for (const auto& [role, lost] : object(s, "lost_roles").items())
    if (lost.is_object())
      rows.push_back({{fmt::format("{:9} {}", role, text(lost, "reason")), CellStyle::kBad}});
  return rows;
}

std::string hertz(std::optional<double> rate) {
  return rate ? fmt::format("{:.1f} Hz", *rate) : "-";
}

Row deviceRow(const std::string& name, const Json& d) {
  const std::string health = text(d, "health"), reason = text(d, "reason");
  if (health != "ok") return healthRow(name, health, "", reason);
  const std::string identity = text(d, "identity");
  const bool both = !identity.empty() && !reason.empty();
  return healthRow(name, health, hertz(number(d, "rate_hz")),
                   identity + (both ? "; " : "") + reason);
}

Row outputRow(const std::string& name, const Json& o) {
  const std::string health = text(o, "health");
  if (health != "ok") return healthRow(name, health, "", text(o, "reason"));
  return healthRow(
      name, health, hertz(number(o, "shown_hz")),
      fmt::format("{}, {} % late", text(o, "kind"), figure(number(o, "late_percent"), 2)));
}

// Returns a row for each service within merlind whose health is not "ok", such as the
// configuration, the state or shared memory.
std::vector<Row> serviceRows(const Json& s) {
  Json failed = Json::object();
  for (const auto& [name, service] : object(s, "services").items())
    if (service.is_object() && text(service, "health") != "ok") failed[name] = service;
  return table(Json{{"services", failed}}, "services", "services",
               [](const std::string& name, const Json& service) {
                 return healthRow(name, text(service, "health"), "", text(service, "reason"));
               });
}

std::string upTime(const Json& s) {
  double most = 0;
  for (const auto& [role, common] : object(s, "roles").items()) {
    if (common.is_object()) most = std::max(most, number(common, "uptime_s").value_or(0));
  }
  if (!(most > 0 && most < 1e9)) return "";
  const auto minutes = static_cast<long>(most / 60);
  if (minutes < 1) return fmt::format("up {:.0f} s", most);
  if (minutes < 60) return fmt::format("up {} min", minutes);
  return fmt::format("up {} h {} min", minutes / 60, minutes % 60);
}

// Returns the time of day, "14:05:07", of an ISO 8601 time; empty if the text is too short.
std::string clockOf(const std::string& time_utc) {
  return time_utc.size() >= 19 ? time_utc.substr(11, 8) : "";
}

// A screen that is filled from the top.
struct Page {
  CellGrid grid;
  bool dim = false;  // whether to show everything dim, because it is out of date
  int next = 0;      // index of the next row to fill

  void add(const Row& row) {
    int column = 0;
    for (const Span& span : row)
      column = grid.put(next, column, span.text, dim ? CellStyle::kDim : span.style);
    ++next;
  }
  int left() const { return grid.rows() - next; }
};

void addTitle(Page& page, const WatchedState& state) {
  const std::string time = clockOf(text(state.status, "time_utc"));
  page.add({{fmt::format("merlin watch: {}", state.name), CellStyle::kHeading},
            {fmt::format("  {}{}{}", time, time.empty() ? "" : " UTC  ", upTime(state.status))}});
  constexpr std::string_view kHint = " q quits";
  page.grid.put(0, page.grid.columns() - static_cast<int>(kHint.size()), kHint, CellStyle::kDim);
  if (state.absent.empty()) return;
  page.grid.put(page.next++, 0, state.absent, CellStyle::kBad);
  page.dim = true;
}

void addChart(Page& page, const WatchedState& state, int rows, bool blocks) {
  const double asked = number(state.status, "rate_asked").value_or(0);
  page.add({});
  page.add({{"frame times of the last minute", CellStyle::kHeading},
            {"  each second's median; ---- is the period", CellStyle::kDim}});
  drawChart(page.grid, {page.next, 2, rows, page.grid.columns() - 2}, state.frame_times,
            asked > 0 ? 1000 / asked : 0, blocks);
  page.next += rows;
}

// Adds a heading and the newest events, as many as fit.
void addEvents(Page& page, const std::vector<WatchedEvent>& events) {
  if (page.left() < 3 || events.empty()) return;
  page.add({});
  page.add({{"last events", CellStyle::kHeading}});
  const auto room = static_cast<std::size_t>(page.left());
  for (std::size_t i = events.size() - std::min(room, events.size()); i < events.size(); ++i)
    page.add(
        {{fmt::format("  {:9} ", clockOf(events[i].time_utc)), CellStyle::kDim}, {events[i].what}});
}

// Returns the number of rows for the bars of the chart: those of the `left` rows that the events do
// not need; 0 if there is no wall or not enough room.
int chartRows(int left, const std::vector<WatchedEvent>& events, bool has_wall) {
  constexpr int kHeadings = 2;  // a blank row and a heading, for the chart and for the events
  const int for_events =
      events.empty() ? 0 : kHeadings + std::min(kLeastEvents, static_cast<int>(events.size()));
  const int rows = std::min(left - for_events - kHeadings, kMostChartRows);
  return has_wall && rows >= kLeastChartRows ? rows : 0;
}

}  // namespace

CellGrid layOut(const WatchedState& state, const ScreenSize& size, bool blocks) {
  Page page{CellGrid(size.rows, size.columns)};
  addTitle(page, state);
  std::vector<Row> rows = lostRows(state.status);
  const auto wall = wallRows(state.status);
  const bool has_wall = !wall.empty();
  rows.insert(rows.end(), wall.begin(), wall.end());
  for (const auto& more :
       {table(state.status, "devices", "devices", deviceRow),
        table(state.status, "outputs", "outputs", outputRow), serviceRows(state.status)})
    rows.insert(rows.end(), more.begin(), more.end());
  const auto all = static_cast<int>(rows.size());
  const int shown = all <= page.left() ? all : std::max(page.left() - 1, 0);
  for (int i = 0; i < shown; ++i) page.add(rows[static_cast<std::size_t>(i)]);
  if (shown < all) {
    page.add({{fmt::format("{} more rows: make the terminal taller", all - shown),
               CellStyle::kWarning}});
    return std::move(page.grid);
  }
  const int bars = chartRows(page.left(), state.events, has_wall);
  if (bars > 0) addChart(page, state, bars, blocks);
  addEvents(page, state.events);
  return std::move(page.grid);
}

}  // namespace merlin::cli
