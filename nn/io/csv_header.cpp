#include "nn/io/csv_header.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
namespace merlin::nn {
namespace {

constexpr const char* kLabelNames[] = {"posture", "label",  "class", "gesture", "sign",
                                       "letter",  "target", "name",  "pose",    "y"};
// Other columns that a recording may have; they are ignored.
constexpr const char* kOtherNames[] = {"",          "index",   "id",     "time",
                                       "timestamp", "t",       "person", "subject",
                                       "user",      "session", "take",   "sample"};
constexpr int kNone = -1;
constexpr std::size_t kMissingOf22[] = {7}, kMissingOf18[] = {6, 7, 10, 14, 18};

template <typename List, typename Value>
bool has(const List& list, const Value& value) {
  return std::find(std::begin(list), std::end(list), value) != std::end(list);
}

// Returns the slot of "s7" or of a joint's name; kNone for any other name.
int slotNamed(const std::string& name) {
  const auto at = std::find(kInputNames.begin(), kInputNames.end(), name);
  if (at != kInputNames.end()) return static_cast<int>(at - kInputNames.begin());
  int slot = kNone;
  if (name.size() < 2 || name[0] != 's') return kNone;
  const auto [end, code] = std::from_chars(name.data() + 1, name.data() + name.size(), slot);
  const bool whole = code == std::errc() && end == name.data() + name.size();
  return whole && slot >= 0 && slot < static_cast<int>(kInputs) ? slot : kNone;
}

// Returns the slots of a glove with that many sensors in the order of its mask; empty if there is
// no such glove.
std::vector<int> slotsOf(std::size_t sensors) {
  std::vector<int> slots;
  for (std::size_t i = 0; i < kInputs; ++i) {
    if (sensors == 22 && has(kMissingOf22, i)) continue;
    if (sensors == 18 && has(kMissingOf18, i)) continue;
    slots.push_back(static_cast<int>(i));
  }
  return slots.size() == sensors ? slots : std::vector<int>();
}

std::optional<std::size_t> labelColumn(const std::vector<std::string>& names) {
  for (const char* label : kLabelNames) {
    const auto at = std::find(names.begin(), names.end(), label);
    if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  }
  for (std::size_t c = 0; c < names.size(); ++c) {  // or a part of the name, as in "class-name"
    for (const char* label : {"label", "class", "posture", "gesture"}) {
      if (names[c].find(label) != std::string::npos) return c;
    }
  }
  return std::nullopt;
}

// Finds the sensors' columns and their slots: by the names if each column has a slot's name,
// otherwise by their number and order.
std::optional<std::string> findSensors(const std::vector<std::string>& names,
                                       const std::vector<std::string>& plain, CsvHeader& header) {
  std::vector<std::size_t> sensors;
  bool named = true;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (c == header.label) continue;
    header.slot[c] = slotNamed(plain[c]);
    const bool other = header.slot[c] == kNone && has(kOtherNames, plain[c]);
    if (other) {
      header.notes.push_back(fmt::format("column \"{}\" is left out", excerpt(names[c])));
      continue;
    }
    sensors.push_back(c);
    named = named && header.slot[c] != kNone;
  }
  // s0 to s21 or s1 to s22 number the 22 sensors, not the slots: gloves with 22 sensors lack
  // slot 7.
  for (const std::size_t c : sensors) {
    const auto slot = static_cast<std::size_t>(std::max(header.slot[c], 0));
    const bool counted = plain[c].size() > 1 && plain[c][0] == 's' && plain[c].size() < 4;
    if (counted && sensors.size() == 22 && has(kMissingOf22, slot)) named = false;
    if (counted && sensors.size() == 18 && has(kMissingOf18, slot)) named = false;
  }
  if (named && !sensors.empty()) return std::nullopt;
  const auto slots = slotsOf(sensors.size());
  if (slots.empty())
    return fmt::format(
        "{} columns of sensors whose names say no slot (\"{}\"); allowed: 18, 22 or "
        "23 of them, the names s0 to s22 or {} to {}, or a choice of columns",
        sensors.size(), sensors.empty() ? "" : excerpt(names[sensors.front()]), kInputNames.front(),
        kInputNames.back());
  for (std::size_t n = 0; n < sensors.size(); ++n) header.slot[sensors[n]] = slots[n];
  header.notes.push_back(
      fmt::format("{} sensors taken in the order of the glove's mask", sensors.size()));
  return std::nullopt;
}

// Tries the text as a name before it tries it as a number, because names may be numbers.
std::optional<std::size_t> columnOf(const std::vector<std::string>& plain,
                                    const std::string& column) {
  const auto at = std::ranges::find(plain, plainName(column));
  if (at != plain.end()) return static_cast<std::size_t>(at - plain.begin());
  std::size_t number = 0;
  const auto [end, code] = std::from_chars(column.data(), column.data() + column.size(), number);
  const bool whole = code == std::errc() && end == column.data() + column.size();
  return whole && number >= 1 && number <= plain.size() ? std::optional(number - 1) : std::nullopt;
}

std::optional<std::string> takeChosen(const std::vector<std::string>& plain,
                                      std::span<const ChosenColumn> chosen,
                                      std::optional<std::size_t>& label, CsvHeader& header) {
  for (const ChosenColumn& choice : chosen) {
    const auto column = columnOf(plain, choice.column);
    if (!column)
      return fmt::format("no column \"{}\" for {}; allowed: 1 to {}, or {}", excerpt(choice.column),
                         excerpt(choice.what), plain.size(),
                         excerpt(fmt::format("{}", fmt::join(plain, ", "))));
    const int slot = slotNamed(plainName(choice.what));
    if (choice.what == "posture")
      label = column;
    else if (slot != kNone)
      header.slot[*column] = slot;
    else
      return fmt::format("a column for \"{}\"; allowed: for posture, s0 to s22 or {} to {}",
                         excerpt(choice.what), kInputNames.front(), kInputNames.back());
  }
  return std::nullopt;
}

}  // namespace

std::string plainName(std::string_view text) {
  const auto outer = [](char c) { return c == '"' || c == '\'' || c == ' ' || c == '\t'; };
  while (!text.empty() && outer(text.front())) text.remove_prefix(1);
  while (!text.empty() && outer(text.back())) text.remove_suffix(1);
  std::string name;
  for (const char c : text) {
    const bool joint = c == ' ' || c == '_';
    name += joint ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

std::optional<std::string> readHeader(const std::vector<std::string>& names, CsvHeader& header,
                                      std::span<const ChosenColumn> chosen) {
  std::vector<std::string> plain;
  for (const std::string& name : names) plain.push_back(plainName(name));
  header.slot.assign(names.size(), kNone);
  std::optional<std::size_t> label;
  if (auto fault = takeChosen(plain, chosen, label, header)) return fault;
  if (!label) label = labelColumn(plain);
  if (!label)
    return fmt::format("no column for the label; allowed: one that is named {}, or a choice of one",
                       fmt::join(kLabelNames, ", "));
  header.label = *label;
  const bool sensors_are_chosen =
      std::ranges::any_of(header.slot, [](int slot) { return slot != kNone; });
  if (!sensors_are_chosen) return findSensors(names, plain, header);
  if (header.slot[*label] != kNone)
    return fmt::format("column \"{}\" as label and as sensor; allowed: one of the two",
                       excerpt(names[*label]));
  header.notes.push_back("columns that were not chosen are left out");
  return std::nullopt;
}

}  // namespace merlin::nn
