#include "config/effective.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/visitor.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;
using Values =
    std::vector<std::pair<std::string, std::string>>;  // pairs of JSON pointer and JSON text

// A visitor that ignores all kinds of settings; derived classes override only the functions for the
// kinds that they need.
class QuietVisitor : public SettingsVisitor {
 public:
  void number(const char*, double&, Range, const char*) override {}
  void integer(const char*, int&, Range, const char*) override {}
  void flag(const char*, bool&, const char*) override {}
  void text(const char*, std::string&, const char*) override {}
  void texts(const char*, std::vector<std::string>&, const char*) override {}
  void path(const char*, std::string&, const char*) override {}
  void choice(const char*, int&, std::span<const char* const>, const char*) override {}
  void numbers(const char*, std::span<double>, Range, const char*) override {}
  void group(const char*, const char*, const std::function<void()>& members) override { members(); }
  void list(const char*, std::size_t count, const char*, const std::function<void(std::size_t)>&,
            const std::function<void(std::size_t)>& member) override {
    for (std::size_t i = 0; i < count; ++i) member(i);
  }
  void excluded(const char*, const char*) override {}
};

class SecretFiles final : public QuietVisitor {
 public:
  void secretFile(const char*, std::string& value, const char*) override {
    if (!value.empty()) names.push_back(value);
  }
  std::vector<std::string> names;
};

// Resizes every list of the visited settings to its number of entries in other settings, given as
// JSON.
class ListLengths final : public QuietVisitor {
 public:
  explicit ListLengths(const Json& written) : at_(&written) {}

  void group(const char* key, const char*, const std::function<void()>& members) override {
    within(child(key), members);
  }
  void list(const char* key, std::size_t count, const char*,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& member) override {
    const Json* const theirs = child(key);
    if (!theirs) return;
    if (theirs->size() != count) resize(theirs->size());
    for (std::size_t i = 0; i < theirs->size(); ++i) within(&(*theirs)[i], [&] { member(i); });
  }

 private:
  const Json* child(const char* key) const {
    return at_ && at_->contains(key) ? &(*at_)[key] : nullptr;
  }
  void within(const Json* object, const std::function<void()>& members) {
    const Json* const outer = std::exchange(at_, object);
    members();
    at_ = outer;
  }
  // Current object of the JSON; null: the JSON has no such object.
  const Json* at_;
};

void flatten(const Json& json, const std::string& pointer, Values& out) {
  const bool objects = json.is_array() && !json.empty() && json.front().is_object();
  if (!json.is_object() && !objects) {
    out.emplace_back(pointer, json.dump(-1, ' ', false, Json::error_handler_t::replace));
  } else if (objects) {
    for (std::size_t i = 0; i < json.size(); ++i)
      flatten(json[i], fmt::format("{}/{}", pointer, i), out);
  } else {
    for (const auto& [key, value] : json.items())
      flatten(value, fmt::format("{}/{}", pointer, key), out);
  }
}

Json written(const Settings& settings, Secrets secrets) {
  return Json::parse(settingsText(settings, secrets));
}

Values flat(const Json& json) {
  Values values;
  flatten(json, "", values);
  return values;
}

std::map<std::string, std::string> byPointer(const Values& values) {
  return {values.begin(), values.end()};
}

std::string find(const std::map<std::string, std::string>& values, const std::string& pointer) {
  const auto found = values.find(pointer);
  return found == values.end() ? std::string() : found->second;
}

std::vector<SettingChange> changes(const Values& before, const Values& after) {
  const auto old = byPointer(before), now = byPointer(after);
  std::vector<SettingChange> out;
  for (const auto& [pointer, value] : after) {
    const std::string was = find(old, pointer);
    if (was != value) out.push_back({pointer, was, value});
  }
  for (const auto& [pointer, value] : before) {
    if (!now.contains(pointer)) out.push_back({pointer, value, {}});
  }
  return out;
}

}  // namespace

std::vector<SettingValue> valuesOf(const Settings& settings, Secrets secrets) {
  const Json json = written(settings, secrets);
  Settings defaults;
  ListLengths lengths(json);
  describe(defaults, lengths);
  const auto usual = byPointer(flat(written(defaults, secrets)));
  std::vector<SettingValue> values;
  for (auto& [pointer, value] : flat(json))
    values.push_back({pointer, value, find(usual, pointer)});
  return values;
}

std::vector<SettingChange> changesBetween(const Settings& before, const Settings& after,
                                          Secrets secrets) {
  return changes(flat(written(before, secrets)), flat(written(after, secrets)));
}

std::vector<SettingChange> changesFromDefaults(const Settings& settings, Secrets secrets) {
  return changesBetween(Settings{}, settings, secrets);
}

std::vector<std::string> secretFilesOf(const Settings& settings) {
  Settings copy = settings;  // describe() needs settings that a visitor may change
  SecretFiles files;
  describe(copy, files);
  return files.names;
}

}  // namespace merlin
