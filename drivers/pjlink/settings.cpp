#include "drivers/pjlink/settings.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"

namespace merlin {
namespace {

constexpr std::string_view kPort = ":4352";  // PJLink's port

bool isName(std::string_view name) {
  return !name.empty() && name.size() <= 32 && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

// Returns whether `input` is valid in PJLink class 1: a kind (1 RGB, 2 VIDEO, 3 DIGITAL, 4 STORAGE,
// 5 NETWORK) and a number from 1 to 9.
bool isInput(std::string_view input) {
  return input.size() == 2 && input[0] >= '1' && input[0] <= '5' && input[1] >= '1' &&
         input[1] <= '9';
}

}  // namespace

std::optional<TcpAddress> projectorAddress(std::string_view text) {
  const bool bare_v6 = text.starts_with('[') && text.ends_with(']');
  const bool port = !bare_v6 && text.find(':') != std::string_view::npos;
  const auto address = parseTcpAddress(fmt::format("tcp://{}{}", text, port ? "" : kPort));
  if (!address || address->host == "*") return std::nullopt;
  return address;
}

std::optional<int> minuteOfDay(std::string_view text) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() != 5 || text[2] != ':') return std::nullopt;
  for (const std::size_t i : {0u, 1u, 3u, 4u}) {
    if (!isDigit(text[i])) return std::nullopt;
  }
  const int hour = (text[0] - '0') * 10 + text[1] - '0';
  const int minute = (text[3] - '0') * 10 + text[4] - '0';
  if (hour > 23 || minute > 59) return std::nullopt;
  return hour * 60 + minute;
}

unsigned weekdayBits(const std::vector<std::string>& names) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < std::size(kWeekdays); ++i) {
    if (std::ranges::find(names, kWeekdays[i]) != names.end()) bits |= 1U << i;
  }
  return bits;
}

SettingFaults validate(const std::vector<PjlinkSettings>& projectors) {
  SettingFaults faults;
  std::set<std::string> names{"panel"};
  std::map<std::pair<std::string, std::string>, std::string> owners;  // by host and port
  if (projectors.size() > kMostProjectors)
    faults.push_back(
        {"", fmt::format("has {} projectors; allowed are {}", projectors.size(), kMostProjectors)});
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    const PjlinkSettings& p = projectors[i];
    const std::string at = fmt::format("/{}", i);
    if (!isName(p.name))
      faults.push_back({at + "/name", fmt::format("is \"{}\"; allowed are 1 to 32 letters, digits, "
                                                  "- and _",
                                                  excerpt(p.name))});
    else if (!names.insert(p.name).second)
      faults.push_back(
          {at + "/name", fmt::format("is \"{}\", the name of {}", p.name,
                                     p.name == "panel" ? "the projectors at the panel's line"
                                                       : "another projector")});
    const auto address = projectorAddress(p.address);
    if (!address)
      faults.push_back({at + "/address", fmt::format("is \"{}\"; allowed is HOST or HOST:PORT, "
                                                     "PORT 1 to 65535",
                                                     excerpt(p.address))});
    else if (const auto [first, fresh] = owners.try_emplace({address->host, address->port}, p.name);
             !fresh)
      faults.push_back(
          {at + "/address", fmt::format("is \"{}\", the address of the projector \"{}\" too",
                                        excerpt(p.address), excerpt(first->second))});
    if (!p.input.empty() && !isInput(p.input))
      faults.push_back(
          {at + "/input", fmt::format("is \"{}\"; allowed are two digits: 1 (RGB), 2 (video), 3 "
                                      "(digital), 4 (storage) or 5 (network), then the number of "
                                      "the input from 1 to 9, or \"\"",
                                      excerpt(p.input))});
  }
  return faults;
}

SettingFaults validate(const std::vector<SwitchingTimes>& schedule) {
  SettingFaults faults;
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    const SwitchingTimes& t = schedule[i];
    const std::string at = fmt::format("/{}", i);
    for (const auto& [key, time] : {std::pair{"/on", &t.on}, std::pair{"/off", &t.off}}) {
      if (!minuteOfDay(*time))
        faults.push_back({at + key, fmt::format("is \"{}\"; allowed is a time from 00:00 to 23:59",
                                                excerpt(*time))});
    }
    if (minuteOfDay(t.on) && t.on == t.off)
      faults.push_back({at + "/off",
                        "is the same time as on; leave out this entry, or change one "
                        "of the two"});
    if (t.days.empty()) faults.push_back({at + "/days", "names no day; leave it out for all days"});
    for (std::size_t d = 0; d < t.days.size(); ++d) {
      if (weekdayBits({t.days[d]}) != 0) continue;
      faults.push_back({fmt::format("{}/days/{}", at, d),
                        fmt::format("is \"{}\"; allowed are {}", excerpt(t.days[d]),
                                    fmt::join(kWeekdays, ", "))});
    }
  }
  return faults;
}

}  // namespace merlin
