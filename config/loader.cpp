#include "config/loader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "config/checks.h"
#include "config/migrate.h"
#include "config/sources.h"
#include "config/visitor.h"
#include "daemon/base/did_you_mean.h"
#include "daemon/base/printable_text.h"
#include "daemon/json/json_tree.h"

namespace merlin {
namespace {

std::string escapePointer(std::string_view key) {
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string movedText(std::string_view is, const MovedSetting& moved) {
  return fmt::format(
      "{} an earlier version; {}; the command merlin config migrate FILE rewrites the file", is,
      moved.now);
}

// Reads the settings from a JSON tree, and adds a finding for each key that is not a setting.
class Loader final : public SettingsVisitor {
 public:
  Loader(const JsonNode& root, std::string folder, LoadedSettings& loaded)
      : folder_(std::move(folder)), loaded_(loaded) {
    enter(&root, "");
  }
  // Reports the unknown keys of the file's root. To be called after describe(); not in the
  // destructor, because it may throw.
  void finish() { leave(); }
  ~Loader() override = default;
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;

  void number(const char* key, double& value, Range range, const char*) override {
    const JsonNode* node = take(key, JsonNode::Kind::kNumber, "a number");
    if (!node) return;
    const bool within = node->number >= range.low && node->number <= range.high;
    if (range.refused && !within) return addRefused(*node, key, range);
    value = clamp(*node, key, range);
  }
  void integer(const char* key, int& value, Range range, const char*) override {
    const JsonNode* node = take(key, JsonNode::Kind::kNumber, "a whole number");
    if (!node) return;
    if (node->number != std::floor(node->number)) return addWrongKind(*node, key, "a whole number");
    value = static_cast<int>(clamp(*node, key, range));
  }
  void flag(const char* key, bool& value, const char*) override {
    if (const JsonNode* node = take(key, JsonNode::Kind::kBool, "true or false"))
      value = node->boolean;
  }
  void text(const char* key, std::string& value, const char*) override {
    if (const JsonNode* node = take(key, JsonNode::Kind::kString, "a string")) value = node->text;
  }
  void texts(const char* key, std::vector<std::string>& values, const char*) override {
    const JsonNode* node = take(key, JsonNode::Kind::kArray, "a list of strings");
    if (!node) return;
    std::vector<std::string> read;
    for (std::size_t i = 0; i < node->items.size(); ++i) {
      const JsonNode& item = node->items[i];
      const std::string at = fmt::format("{}/{}", key, i);
      lines_[pointer(at)] = item.line;
      if (item.kind == JsonNode::Kind::kString)
        read.push_back(item.text);
      else
        addWrongKind(item, at, "a string");
    }
    if (read.size() == node->items.size()) values = std::move(read);
  }
  void path(const char* key, std::string& value, const char*) override {
    const JsonNode* node = take(key, JsonNode::Kind::kString, "a file name");
    if (!node) return;
    value = node->text.empty()
                ? ""
                : (std::filesystem::path(folder_) / node->text).lexically_normal().string();
  }
  void choice(const char* key, int& value, std::span<const char* const> names,
              const char*) override {
    const std::string allowed = fmt::format("one of {}", fmt::join(names, ", "));
    // The names are in quotes to help people who wrote the number 180 instead of "180".
    const JsonNode* node = take(key, JsonNode::Kind::kString,
                                fmt::format("one of \"{}\"", fmt::join(names, "\", \"")));
    if (!node) return;
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const char* n) { return node->text == n; });
    if (found == names.end()) return addWrongKind(*node, key, allowed);
    value = static_cast<int>(found - names.begin());
  }
  void numbers(const char* key, std::span<double> values, Range range, const char*) override {
    const std::string allowed = fmt::format("a list of {} numbers", values.size());
    const JsonNode* node = take(key, JsonNode::Kind::kArray, allowed);
    if (!node) return;
    if (node->items.size() != values.size()) return addWrongKind(*node, key, allowed);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string item = fmt::format("{}/{}", key, i);
      if (node->items[i].kind != JsonNode::Kind::kNumber)
        addWrongKind(node->items[i], item, "a number");
      else
        values[i] = clamp(node->items[i], item, range);
    }
  }
  void wholeNumbers(const char* key, std::span<double> values, Range range,
                    const char* help) override {
    numbers(key, values, range, help);
    const JsonNode* list = levels_.back().object ? memberOf(*levels_.back().object, key) : nullptr;
    for (std::size_t i = 0; list && i < list->items.size(); ++i) {
      const JsonNode& item = list->items[i];
      if (item.kind == JsonNode::Kind::kNumber && item.number != std::floor(item.number))
        addWrongKind(item, fmt::format("{}/{}", key, i), "a whole number");
    }
  }
  void group(const char* key, const char*, const std::function<void()>& members) override {
    enter(take(key, JsonNode::Kind::kObject, "an object"), pointer(key));
    members();
    leave();
  }
  void list(const char* key, std::size_t, const char*,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& member) override {
    const JsonNode* node = take(key, JsonNode::Kind::kArray, "a list of objects");
    if (!node) return;
    resize(node->items.size());
    for (std::size_t i = 0; i < node->items.size(); ++i) {
      lines_[pointer(fmt::format("{}/{}", key, i))] = node->items[i].line;
      const bool object = node->items[i].kind == JsonNode::Kind::kObject;
      if (!object) addWrongKind(node->items[i], fmt::format("{}/{}", key, i), "an object");
      enter(object ? &node->items[i] : nullptr, pointer(fmt::format("{}/{}", key, i)));
      member(i);
      leave();
    }
  }

  void excluded(const char* key, const char* what) override {
    Level& level = levels_.back();
    level.known.emplace_back(key);
    if (!level.object) return;
    for (const auto& member : level.object->members) {
      if (member.key == key) loaded_.add({false, member.line, pointer(key), what});
    }
  }

  const std::map<std::string, int>& lines() const { return lines_; }

 private:
  struct Level {
    const JsonNode* object;  // null if the file has no such object
    std::string pointer;
    std::vector<std::string> known;
  };

  std::string pointer(std::string_view key) const {
    return fmt::format("{}/{}", levels_.back().pointer, key);
  }

  void enter(const JsonNode* object, const std::string& pointer) {
    levels_.push_back({object, pointer, {}});
  }

  // Leaves the object and reports its keys that describe() did not mention.
  void leave() {
    const Level& level = levels_.back();
    static const std::vector<JsonNode::Member> kNone;
    for (const auto& member : level.object ? level.object->members : kNone) {
      if (std::find(level.known.begin(), level.known.end(), member.key) != level.known.end())
        continue;
      if (member.key == "$schema" && levels_.size() == 1) continue;
      loaded_.add({false, member.line, level.pointer + "/" + escapePointer(member.key),
                   whatOf(level.pointer + "/" + member.key, member.key, level.known)});
    }
    levels_.pop_back();
  }

  std::string whatOf(const std::string& pointer, const std::string& key,
                     const std::vector<std::string>& known) const {
    if (const MovedSetting* moved = findMoved(pointer)) return movedText("is a setting of", *moved);
    return "is not a known setting; " + suggestion(key, known);
  }

  std::string suggestion(const std::string& key, const std::vector<std::string>& known) const {
    if (loaded_.left_out > 0) return {};  // the new finding will only be counted, not kept
    // Limits the cost of nearestWord(), which is quadratic in the key's length.
    constexpr std::size_t kLongest = 64;
    const std::string near = key.size() > kLongest ? "" : nearestWord(key, known);
    return near.empty() ? fmt::format("known here are {}", fmt::join(known, ", "))
                        : fmt::format("did you mean \"{}\"?", near);
  }

  static const JsonNode* memberOf(const JsonNode& object, std::string_view key) {
    for (const auto& member : object.members) {
      if (member.key == key) return &member.value;
    }
    return nullptr;
  }

  // Returns the value of `key`, or null if the key is missing. If the value is of another kind or
  // contains NUL, adds a finding and returns null.
  const JsonNode* take(const char* key, JsonNode::Kind kind, std::string_view allowed) {
    Level& level = levels_.back();
    level.known.emplace_back(key);
    if (!level.object) return nullptr;
    for (const auto& member : level.object->members) {
      if (member.key != key) continue;
      lines_[pointer(key)] = member.line;
      const bool whole = member.value.text.find('\0') == std::string::npos;
      if (member.value.kind == kind && whole) return &member.value;
      if (!whole)
        allowed = "a text without the character NUL, where the operating system would truncate it";
      if (member.value.kind == JsonNode::Kind::kObject) {
        if (const MovedSetting* moved = findMoved(pointer(key))) {
          loaded_.add({false, member.line, pointer(key), movedText("is an object, as in", *moved)});
          return nullptr;
        }
      }
      addWrongKind(member.value, key, allowed);
      return nullptr;
    }
    return nullptr;
  }

  void addWrongKind(const JsonNode& node, std::string_view key, std::string_view allowed) {
    loaded_.add({false, node.line, pointer(key),
                 fmt::format("is {}; allowed is {}", describe(node), allowed), true});
  }

  void addRefused(const JsonNode& node, std::string_view key, Range range) {
    loaded_.add({false, node.line, pointer(key),
                 fmt::format("is {}; allowed is {} to {}; {}", node.number, range.low, range.high,
                             range.refused)});
  }

  double clamp(const JsonNode& node, std::string_view key, Range range) {
    const double value = std::clamp(node.number, range.low, range.high);
    if (value == node.number) return value;
    if (std::isnan(node.number)) {
      addWrongKind(node, key, "a number");
      return range.low;
    }
    loaded_.add({true, node.line, pointer(key),
                 fmt::format("is {}; allowed is {} to {}; {} is used", node.number, range.low,
                             range.high, value)});
    return value;
  }

  std::string folder_;
  LoadedSettings& loaded_;
  std::vector<Level> levels_;
  std::map<std::string, int> lines_;
};

}  // namespace

LoadedSettings::Verdict LoadedSettings::verdict() const {
  if (findings.empty()) return Verdict::kValid;
  const bool all_adjusted =
      !left_out_invalid_ &&
      std::all_of(findings.begin(), findings.end(), [](const Finding& f) { return f.adjusted; });
  return all_adjusted ? Verdict::kAdjusted : Verdict::kInvalid;
}

int LoadedSettings::lineOf(const std::string& pointer) const {
  for (std::string at = pointer; !at.empty(); at.resize(at.rfind('/'))) {
    if (const auto found = lines.find(at); found != lines.end()) return found->second;
  }
  return 0;
}

void LoadedSettings::addFinding(const std::string& pointer, std::string what) {
  add({false, lineOf(pointer), pointer, std::move(what)});
}

LoadedSettings::Place LoadedSettings::placeAt(int line) const {
  for (const Source& source : sources) {
    if (line > source.lines_before && line <= source.last_line)
      return {source.file, line - source.lines_before};
  }
  return {{}, line};
}

std::string LoadedSettings::placeText(const std::string& pointer) const {
  const auto [file, line] = placeAt(lineOf(pointer));
  return file.empty() ? fmt::format("line {}", line) : fmt::format("{}:{}", file, line);
}

void LoadedSettings::add(Finding finding) {
  if (finding.file.empty()) {
    const Place place = placeAt(finding.line);
    finding.file = place.file;
    finding.line = place.line;
  }
  if (findings.size() < kMostFindings) return findings.push_back(std::move(finding));
  ++left_out;
  left_out_invalid_ = left_out_invalid_ || !finding.adjusted;
}

void LoadedSettings::sortFindings() {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return std::tie(a.file, a.line) < std::tie(b.file, b.line);
  });
}

namespace {

void loadTree(const JsonNode& tree, const std::string& folder, LoadedSettings& loaded) {
  {
    Loader loader(tree, folder, loaded);
    describe(loaded.settings, loader);
    loader.finish();
    loaded.lines = loader.lines();
  }
  loaded.parsed = true;
  checkTogether(loaded);
}

}  // namespace

LoadedSettings loadSettings(std::string_view json, const std::string& folder) {
  LoadedSettings loaded;
  if (const auto tree = parseSource(json, "", loaded)) loadTree(*tree, folder, loaded);
  loaded.sortFindings();
  return loaded;
}

LoadedSettings loadSettingsFile(const std::string& path) {
  LoadedSettings loaded;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  if (const auto tree = readSources(path, loaded)) loadTree(*tree, folder, loaded);
  loaded.sortFindings();
  return loaded;
}

std::string toText(const std::string& file, const Finding& f) {
  std::string text = f.file.empty() ? file : f.file;
  if (f.line > 0) text += fmt::format(":{}", f.line);
  if (!f.pointer.empty()) text += ": " + f.pointer;
  return oneLine(text + (f.pointer.empty() ? ": " : " ") + f.what);
}

}  // namespace merlin
