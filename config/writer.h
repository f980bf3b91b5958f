// Writing settings: the JSON Schema of a configuration, and a configuration with every value in it.
#pragma once

#include <string>

#include "config/settings.h"

namespace merlin {

// JSON Schema, draft 2020-12, with every default; config/merlin.schema.json is this text.
std::string settingsSchema();

// Every setting with the value that holds.
std::string settingsText(const Settings& settings);

}  // namespace merlin
