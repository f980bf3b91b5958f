// What the subcommands of `merlin calibrate` share: settings into a configuration file.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"

namespace merlin::cli {

// Puts the members of `values` under /devices/DEVICE of the configuration `path`, and leaves all
// else there as it is; makes the file where there is none. Comments cannot be in JSON, order is
// kept. Errors: kMalformed (no JSON object), kIo; the old file stays where anything fails.
Result<Ok> saveDeviceSettings(const std::string& path, const std::string& device,
                              const nlohmann::ordered_json& values);

void addCalibrateGlove(CLI::App& calibrate, Run& run);
void addCalibrateImport(CLI::App& calibrate, Run& run);
void addCalibrateTracker(CLI::App& calibrate, Run& run);
void addCalibrateBall(CLI::App& calibrate, Run& run);

}  // namespace merlin::cli
