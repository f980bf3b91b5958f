// Writes the JSON Schema of configurations, and a configuration that contains every setting.
#pragma once

#include <string>

#include "config/settings.h"

namespace merlin {

// The JSON Schema (draft 2020-12) of a configuration, with every default; this is the text of
// config/merlin.schema.json.
std::string settingsSchema();

// kLeftOut: the names of files that hold secrets are replaced by kSecretLeftOut.
enum class Secrets { kWritten, kLeftOut };
inline constexpr const char* kSecretLeftOut = "(left out)";

// A configuration that has every setting with its value in `settings`. Files have absolute names:
// relative ones are taken from the working directory.
std::string settingsText(const Settings& settings, Secrets secrets = Secrets::kWritten);

}  // namespace merlin
