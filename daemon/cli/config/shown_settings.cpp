#include "daemon/cli/config/shown_settings.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRate = "/wall/rate/rate_hz";

// Returns whether the setting at pointer `at` belongs to a list entry that a file contains.
bool isOfListedEntry(const LoadedSettings& loaded, std::string at) {
  for (; !at.empty(); at.resize(at.rfind('/'))) {
    const char first = at[at.rfind('/') + 1];
    if (first >= '0' && first <= '9' && loaded.lines.contains(at)) return true;
  }
  return false;
}

// Fills in origin, file and line. If a list entry in a file omits the setting, its default becomes
// the value in effect (such as the baud rate of the entry's driver) instead of the value in the
// default list, which the list in the file replaces.
void findOrigin(const LoadedSettings& loaded, const std::string& file, ShownSetting& shown) {
  SettingValue& setting = shown.setting;
  const bool own = loaded.lines.contains(setting.pointer);
  if (!own && isOfListedEntry(loaded, setting.pointer)) setting.default_value = setting.value;
  const int line = own || shown.differs() ? loaded.lineOf(setting.pointer) : 0;
  if (line == 0) return;
  const auto place = loaded.placeAt(line);
  shown.origin = Origin::kFile;
  shown.file = place.file.empty() ? file : place.file;
  shown.line = place.line;
}

std::string originText(const ShownSetting& s) {
  switch (s.origin) {
    case Origin::kFile: return fmt::format("{}:{}", s.file, s.line);
    case Origin::kState: return fmt::format("changed while the wall ran: {}", s.file);
    case Origin::kDefault: break;
  }
  return {};
}

Json parsedSetting(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json::parse(text, nullptr, false);
}

}  // namespace

std::vector<ShownSetting> shownSettings(const LoadedSettings& loaded, const std::string& file,
                                        const RunTimeChanges* changes) {
  std::vector<ShownSetting> out;
  for (SettingValue& value : valuesOf(loaded.settings)) {
    ShownSetting shown{std::move(value), Origin::kDefault, {}, 0};
    findOrigin(loaded, file, shown);
    if (changes && changes->state.rate_hz && shown.setting.pointer == kRate) {
      shown.setting.value = Json(*changes->state.rate_hz).dump();
      shown.origin = Origin::kState;
      shown.file = changes->file;
      shown.line = 0;
    }
    out.push_back(std::move(shown));
  }
  return out;
}

std::string settingsLines(std::span<const ShownSetting> settings) {
  std::string text;
  for (const ShownSetting& s : settings) {
    std::string note = originText(s);
    if (s.differs() && !s.setting.default_value.empty())
      note += fmt::format("{}default {}", note.empty() ? "" : "; ", s.setting.default_value);
    text += fmt::format("{} {}: {}{}\n", s.differs() ? "*" : " ", s.setting.pointer,
                        s.setting.value, note.empty() ? "" : fmt::format("  ({})", note));
  }
  return text;
}

std::string changesLines(const RunTimeChanges& changes) {
  const state::State& s = changes.state;
  std::string text;
  for (const auto& output : s.alignment.outputs)
    text += fmt::format("  alignment of the output {}\n", output.form.output);
  if (!s.content.empty()) text += fmt::format("  the content that is shown: {}\n", s.content);
  if (s.playlist_off) text += "  the playlist is off\n";
  if (s.projectors)
    text += fmt::format("  projectors were switched {}\n", s.projectors->on ? "on" : "off");
  if (text.empty()) return {};
  return fmt::format("Also changed while the wall ran, in {}:\n{}", changes.file, text);
}

std::string settingsJson(std::span<const ShownSetting> settings) {
  Json list = Json::array();
  for (const ShownSetting& s : settings) {
    list.push_back({{"pointer", s.setting.pointer},
                    {"value", parsedSetting(s.setting.value)},
                    {"default", parsedSetting(s.setting.default_value)},
                    {"differs", s.differs()},
                    {"origin", kOriginNames[static_cast<int>(s.origin)]},
                    {"file", s.file},
                    {"line", s.line}});
  }
  return jsonText(list);
}

}  // namespace merlin::cli
