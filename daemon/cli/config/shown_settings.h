// The settings in effect with the place where each comes from, as text and as JSON. Pure.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/effective.h"
#include "config/loader.h"
#include "daemon/state/state.h"

namespace merlin::cli {

// kDefault: no file has the setting. kFile: the configuration or a file of conf.d. kState: people
// changed it while the wall ran.
enum class Origin { kDefault, kFile, kState };
inline constexpr const char* kOriginNames[] = {"default", "file", "state"};

struct ShownSetting {
  SettingValue setting;  // if a list entry omits it, its default is the value in effect
  Origin origin = Origin::kDefault;
  std::string file;  // for kFile and kState
  int line = 0;      // for kFile
  bool differs() const { return setting.value != setting.default_value; }
};

// What people changed while the wall ran, in the file `file`.
struct RunTimeChanges {
  std::string file;
  state::State state;
};

// Every setting, in the order of written files. `file`: the configuration. `changes`: null if there
// are none.
std::vector<ShownSetting> shownSettings(const LoadedSettings& loaded, const std::string& file,
                                        const RunTimeChanges* changes);

// One line each, "* /wall/rate/rate_hz: 25  (merlin.json:7; default 30)"; a star marks what differs
// from the default.
std::string settingsLines(std::span<const ShownSetting> settings);

// The other changes at run time, for which there is no setting, one line each; empty if there are
// none.
std::string changesLines(const RunTimeChanges& changes);

// [{"pointer", "value", "default", "differs", "origin", "file", "line"}, ...]; "default" is null
// for a setting that is in a file and exists only because of other settings.
std::string settingsJson(std::span<const ShownSetting> settings);

}  // namespace merlin::cli
