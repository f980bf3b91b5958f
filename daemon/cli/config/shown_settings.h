// Lists the settings in effect with the origin of each value, as text and as JSON. Pure.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/effective.h"
#include "config/loader.h"
#include "daemon/state/state.h"

namespace merlin::cli {

// Where a value comes from. kDefault: the default, since no file contains the setting. kFile: the
// configuration or a file of conf.d. kState: the state file, since people changed the value while
// the wall ran.
enum class Origin { kDefault, kFile, kState };
inline constexpr const char* kOriginNames[] = {"default", "file", "state"};

struct ShownSetting {
  // The value and its default. If a list entry in a file omits the setting, its default is the
  // value in effect.
  SettingValue setting;
  Origin origin = Origin::kDefault;
  std::string file;  // name of the file, for kFile and kState
  int line = 0;      // line in `file`, for kFile; otherwise 0
  bool differs() const { return setting.value != setting.default_value; }
};

// The state of the wall, which contains what people changed while it ran, and the name of the state
// file.
struct RunTimeChanges {
  std::string file;
  state::State state;
};

// Returns every setting, in the order in which settingsText() writes them. `file`: name of the
// configuration. `changes`: may be null.
std::vector<ShownSetting> shownSettings(const LoadedSettings& loaded, const std::string& file,
                                        const RunTimeChanges* changes);

// Returns one line for each setting, "* /wall/rate/rate_hz: 25 (merlin.json:7; default 30)"; a star
// marks values that differ from the default.
std::string settingsLines(std::span<const ShownSetting> settings);

// Returns a heading and one line for each change at run time for which there is no setting, such as
// an alignment; empty if there are none.
std::string changesLines(const RunTimeChanges& changes);

// Returns the JSON list [{"pointer", "value", "default", "differs", "origin", "file", "line"},
// ...]. "default" is null if the setting has no default, because it exists only as a consequence of
// other settings.
std::string settingsJson(std::span<const ShownSetting> settings);

}  // namespace merlin::cli
