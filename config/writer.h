// Writes the JSON Schema of configurations, and configurations that contain every setting.
#pragma once

#include <string>

#include "config/settings.h"

namespace merlin {

// Returns the JSON Schema (draft 2020-12) of configurations, with the defaults of the settings; it
// is the text of config/merlin.schema.json.
std::string settingsSchema();

// Whether a written configuration contains the names of files with secrets (kWritten), or
// kSecretLeftOut instead of each (kLeftOut).
enum class Secrets { kWritten, kLeftOut };
inline constexpr const char* kSecretLeftOut = "(left out)";

// Returns a configuration that contains every setting with its value in `settings`. File names in
// it are absolute; relative ones are taken as relative to the working directory.
std::string settingsText(const Settings& settings, Secrets secrets = Secrets::kWritten);

}  // namespace merlin
