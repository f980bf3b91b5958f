// Settings of projectors that are controlled over the network by PJLink, and the times of day at
// which all projectors are switched.
#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "daemon/base/tcp_address.h"

namespace merlin {

struct PjlinkSettings {
  std::string name;
  std::string address;             // "HOST", "HOST:PORT" or "[::1]:PORT"
  std::string password_file = {};  // empty: the projector asks for no password
  std::string input = {};          // selected after each switching on, such as "31"; empty: none
  // Longest times from a power command until the projector must report that it is on, or off.
  double warm_up_s = 120;
  double cool_down_s = 300;
};

inline constexpr const char* kWeekdays[] = {"mon", "tue", "wed", "thu", "fri", "sat", "sun"};

// Days on which projectors are switched on, and the local times "HH:MM". If `off` is not later than
// `on`, it is a time of the next day.
struct SwitchingTimes {
  std::vector<std::string> days{std::begin(kWeekdays), std::end(kWeekdays)};
  std::string on;
  std::string off;
};

inline constexpr std::size_t kMostProjectors = 32;  // each has a thread

// Parses a projector's address; the default port is 4352. Returns nothing if the text is not an
// address.
std::optional<TcpAddress> projectorAddress(std::string_view text);

// Parses "HH:MM" from 00:00 to 23:59 to minutes after midnight; returns nothing if the text is not
// a time.
std::optional<int> minuteOfDay(std::string_view text);

// Returns a number in which bit i is set if kWeekdays[i] is among the names. Other names are
// ignored.
unsigned weekdayBits(const std::vector<std::string>& names);

// Return faults for projectors without a valid name or with the name or address of another, and for
// invalid addresses, inputs, days and times. Their JSON pointers begin with the index of the entry,
// as in "/2/name".
SettingFaults validate(const std::vector<PjlinkSettings>& projectors);
SettingFaults validate(const std::vector<SwitchingTimes>& schedule);

}  // namespace merlin
