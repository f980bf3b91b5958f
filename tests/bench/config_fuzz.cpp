#include "tests/bench/config_fuzz.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/loader.h"
#include "config/writer.h"

namespace merlin::bench {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;
using Outcome = ConfigFuzz::Outcome;

constexpr const char* kFolder = "/etc/merlin";

// ---- mutation

// Adds pointers to all values of the tree, except for its root.
void collect(const Json& at, const Pointer& pointer, std::vector<Pointer>& all) {
  if (at.is_object()) {
    for (const auto& [key, value] : at.items()) {
      const Pointer here = pointer / key;
      all.push_back(here);
      collect(value, here, all);
    }
  }
  if (at.is_array()) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Pointer here = pointer / i;
      all.push_back(here);
      collect(at[i], here, all);
    }
  }
}

template <typename List>
const auto& oneOf(const List& list, Random& r) {
  return list[static_cast<std::size_t>(r.below(std::size(list)))];
}

Json strangeValue(Random& r) {
  static const std::vector<Json> kValues = {nullptr,
                                            true,
                                            false,
                                            0,
                                            -1,
                                            1,
                                            2.5,
                                            1e308,
                                            -1e308,
                                            5e-324,
                                            4294967296,
                                            -2147483649LL,
                                            9223372036854775807LL,
                                            18446744073709551615ULL,
                                            "",
                                            "x",
                                            "\xC3\xA4/../..",
                                            std::string(1, '\0'),
                                            std::string(5000, 'a'),
                                            "tcp://*:7401",
                                            "tcp://",
                                            "/dev/null",
                                            Json::array(),
                                            Json::object(),
                                            Json::array({1}),
                                            Json::array({Json::object()}),
                                            Json::array({"a", "b", "c"}),
                                            Json::array({0, 0, 0}),
                                            Json::object({{"x", 1}}),
                                            Json::array({Json::array()})};
  return oneOf(kValues, r);
}

// Returns a key that differs slightly from this one.
std::string nearKey(std::string key, Random& r) {
  const auto at = static_cast<std::size_t>(r.below(key.size() + 1));
  switch (r.below(5)) {
    case 0: key.insert(at, 1, static_cast<char>('a' + r.below(26))); break;
    case 1:
      if (at < key.size()) key.erase(at, 1);
      break;
    case 2:
      if (at < key.size()) key[at] = static_cast<char>(std::toupper(key[at]));
      break;
    case 3: key += r.below(2) == 0 ? " " : "s"; break;
    default: key.insert(0, r.below(2) == 0 ? "_" : "/"); break;
  }
  return key;
}

// Replaces the member's key and keeps its value; does nothing to an item of a list.
void renameKey(Json& root, const Pointer& at, Random& r) {
  Json& parent = root[at.parent_pointer()];
  if (!parent.is_object()) return;
  const Json value = parent[at.back()];
  parent.erase(at.back());
  parent[nearKey(at.back(), r)] = value;
}

void addUnknownKey(Json& root, const Pointer& at, Random& r) {
  static constexpr const char* kKeys[] = {"x", "rate_hz", "name", "port",  "enabled", "comment",
                                          "",  "$schema", "//",   "tiles", "kind",    "path"};
  Json& value = root[at];
  if (value.is_object()) value[oneOf(kKeys, r)] = strangeValue(r);
}

// Copies a part of the tree to another place, in addition to what is there.
void moveSubtree(Json& root, const Pointer& from, const Pointer& to) {
  const Json value = root[from];
  Json& parent = root[to];
  if (parent.is_object() && !from.empty()) parent[from.back()] = value;
  if (parent.is_array()) parent.push_back(value);
}

void repeatItems(Json& root, const Pointer& at, Random& r) {
  Json& value = root[at];
  if (!value.is_array() || value.empty() || value.size() > 100) return;
  const Json item = value[static_cast<std::size_t>(r.below(value.size()))];
  for (std::uint64_t n = r.below(2) == 0 ? 1 : r.below(300); n > 0; --n) value.push_back(item);
}

void erase(Json& root, const Pointer& at) {
  Json& parent = root[at.parent_pointer()];
  if (parent.is_object()) parent.erase(at.back());
  if (parent.is_array()) parent.erase(static_cast<std::size_t>(std::stoul(at.back())));
}

void changeNumber(Json& root, const Pointer& at, Random& r) {
  Json& value = root[at];
  if (!value.is_number()) return;
  const double x = value.get<double>();
  const double changed[] = {-x, x * 10, x / 3, x + 0.5, x * 1e12, x - 1};
  value = oneOf(changed, r);
}

void mutateTree(Json& root, Random& r) {
  std::vector<Pointer> all;
  collect(root, Pointer(), all);
  if (all.empty()) return;
  const Pointer at = oneOf(all, r), other = oneOf(all, r);
  switch (r.below(9)) {
    case 0: return renameKey(root, at, r);
    case 1: return addUnknownKey(root, at, r);
    case 2: root[at] = strangeValue(r); return;
    case 3: return moveSubtree(root, at, other);
    case 4: return repeatItems(root, at, r);
    case 5: return erase(root, at);
    case 6: root[at] = Json(root[other]); return;
    case 7: return changeNumber(root, at, r);
    default: return addUnknownKey(root, Pointer(), r);
  }
}

// Duplicates a member of the text, as a careless merge does.
void doubleMember(std::string& text, Random& r) {
  const std::size_t from = text.find('"', r.below(text.size()));
  const std::size_t to = from == std::string::npos ? from : text.find(',', from);
  if (to != std::string::npos) text.insert(from, text.substr(from, to + 1 - from));
}

void mutateText(std::string& text, Random& r) {
  static const std::string kTokens[] = {"//",      "/*",   "*/",   ",", "NaN",  "1e999",
                                        "\\u0000", "\"",   "{",    "]", "\xFF", "\xEF\xBB\xBF",
                                        "-",       "0x10", "\n\n", "'"};
  if (text.empty()) return;
  const auto at = static_cast<std::size_t>(r.below(text.size()));
  const auto length = std::min<std::size_t>(text.size() - at, 1 + r.below(20));
  switch (r.below(6)) {
    case 0: text[at] = static_cast<char>(r.below(256)); break;
    case 1: text.erase(at, length); break;
    case 2: text.insert(at, text.substr(at, length)); break;
    case 3: text.insert(at, oneOf(kTokens, r)); break;
    case 4: text.resize(at); break;
    default: doubleMember(text, r); break;
  }
}

// ---- judgement

// Notes keys that occur twice in one object while nlohmann-json parses the text.
class KeysTwice {
 public:
  bool operator()(int, Json::parse_event_t event, const Json& value) {
    if (event == Json::parse_event_t::object_start) seen_.emplace_back();
    if (event == Json::parse_event_t::object_end) seen_.pop_back();
    if (event == Json::parse_event_t::key && !seen_.back().insert(value.get<std::string>()).second)
      twice = value.get<std::string>();
    return true;
  }
  std::string twice;

 private:
  std::vector<std::set<std::string>> seen_;
};

bool isSame(const Json& written, const Json& used) {
  if (written.is_number() && used.is_number()) {
    const double a = written.get<double>(), b = used.get<double>();
    return std::abs(a - b) <= 1e-6 * std::max({1.0, std::abs(a), std::abs(b)});
  }
  if (written == used) return true;
  if (!written.is_string() || !used.is_string()) return false;
  const std::filesystem::path path(written.get<std::string>());
  return used == (kFolder / path).lexically_normal().string();
}

// Returns whether the value stands for the driver's own default, as the setting's help describes
// it: baud 0 or an empty name.
bool isTheDriversOwn(const Pointer& at, const Json& written) {
  if (!at.to_string().starts_with("/devices/")) return false;
  return (at.back() == "baud" && written == 0) || (at.back() == "name" && written == "");
}

// Returns the pointer to the first value of the text that the settings lack; empty if they have all
// values.
std::string ignoredIn(const Json& written, const Json& used, const LoadedSettings& loaded,
                      const Pointer& at = Pointer()) {
  const auto adjusted = [&](const Finding& f) { return f.pointer == at.to_string(); };
  if (written.is_object() && used.is_object()) {
    for (const auto& [key, value] : written.items()) {
      if (at.empty() && key == "$schema") continue;
      if (!used.contains(key)) return (at / key).to_string();
      auto ignored = ignoredIn(value, used[key], loaded, at / key);
      if (!ignored.empty()) return ignored;
    }
    return {};
  }
  if (written.is_array() && used.is_array() && written.size() == used.size()) {
    for (std::size_t i = 0; i < written.size(); ++i) {
      auto ignored = ignoredIn(written[i], used[i], loaded, at / i);
      if (!ignored.empty()) return ignored;
    }
    return {};
  }
  const bool known = isSame(written, used) || isTheDriversOwn(at, written) ||
                     std::ranges::any_of(loaded.findings, adjusted);
  return known ? "" : at.to_string();
}

// Returns the difference between the accepted settings and the text; empty if there is none.
std::string faultOf(const std::string& text, const LoadedSettings& loaded) {
  KeysTwice keys;
  const Json written = Json::parse(text, std::ref(keys), false);
  if (written.is_discarded()) return "accepts a text that is no JSON";
  if (!keys.twice.empty()) return "accepts a key twice: " + keys.twice;
  const std::string used = settingsText(loaded.settings);
  const std::string ignored = ignoredIn(written, Json::parse(used, nullptr, false), loaded);
  if (!ignored.empty()) return "ignores " + ignored;
  const LoadedSettings again = loadSettings(used, kFolder);
  if (again.verdict() == LoadedSettings::Verdict::kInvalid)
    return "refuses the settings that it has written: " + toText("again", again.findings.front());
  return settingsText(again.settings) == used ? "" : "reads other settings than it has written";
}

}  // namespace

std::string ConfigFuzz::mutated(Random& r) const {
  Json tree = Json::parse(oneOf(examples_, r));
  for (std::uint64_t n = 1 + r.below(3); n > 0; --n) mutateTree(tree, r);
  std::string text =
      tree.dump(r.below(2) == 0 ? -1 : 2, ' ', false, Json::error_handler_t::replace);
  if (r.below(4) == 0) {
    for (std::uint64_t n = 1 + r.below(3); n > 0; --n) mutateText(text, r);
  }
  return text;
}

ConfigFuzz::Result ConfigFuzz::run(std::uint64_t seed) const {
  Random random(seed);
  return judge(mutated(random));
}

ConfigFuzz::Result ConfigFuzz::judge(std::string text) {
  const LoadedSettings loaded = loadSettings(text, kFolder);
  Result result{Outcome::kNoJson, "", std::move(text)};
  for (const Finding& finding : loaded.findings) {
    if (finding.what.empty()) result.fault = "a finding has no text";
  }
  if (!loaded.parsed) {
    if (loaded.findings.empty()) result.fault = "refuses without a finding";
    return result;
  }
  switch (loaded.verdict()) {
    case LoadedSettings::Verdict::kInvalid: result.outcome = Outcome::kInvalid; return result;
    case LoadedSettings::Verdict::kAdjusted: result.outcome = Outcome::kAdjusted; break;
    case LoadedSettings::Verdict::kValid: result.outcome = Outcome::kValid; break;
  }
  if (result.fault.empty()) result.fault = faultOf(result.text, loaded);
  return result;
}

}  // namespace merlin::bench
