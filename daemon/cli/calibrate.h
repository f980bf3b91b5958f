// What the subcommands of `merlin calibrate` share: settings into a configuration file.
#pragma once

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/arguments.h"
#include "daemon/cli/command.h"

namespace merlin::cli {

// The configuration `path`, or an empty one where there is none; /devices/DEVICE is made where it
// is not there. Errors: kMalformed (no JSON object, or one of these is none), kIo.
Result<nlohmann::ordered_json> readConfiguration(const std::string& path,
                                                 const std::string& device);

// Puts the members of `values` under /devices/DEVICE of the configuration `path`, and leaves all
// else there as it is; makes the file where there is none. Comments cannot be in JSON, order is
// kept. Errors: kMalformed (no JSON object), kIo; the old file stays where anything fails.
Result<Ok> saveDeviceSettings(const std::string& path, const std::string& device,
                              const nlohmann::ordered_json& values);

// Numbers as short as they are exact enough.
template <typename T>
nlohmann::ordered_json numbers(const T& values) {
  auto list = nlohmann::ordered_json::array();
  for (const auto v : values) list.push_back(std::stod(fmt::format("{:.7g}", v)));
  return list;
}

void addCalibrateGlove(Command calibrate, Run& run);
void addCalibrateImport(Command calibrate, Run& run);
void addCalibrateTracker(Command calibrate, Run& run);
void addCalibrateBall(Command calibrate, Run& run);

}  // namespace merlin::cli
