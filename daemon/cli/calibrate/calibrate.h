// Helpers of the `merlin calibrate` subcommands: they write settings into a configuration file.
#pragma once

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/arguments.h"
#include "daemon/cli/command.h"

namespace merlin::cli {

// Reads the configuration `path`, or an empty one if the file does not exist; adds /devices/DEVICE
// if it is missing. Errors: kMalformed (the file, /devices or /devices/DEVICE is not a JSON
// object), kIo.
Result<nlohmann::ordered_json> readConfiguration(const std::string& path,
                                                 const std::string& device);

// Sets the members of `values` in /devices/DEVICE of the configuration `path` and keeps all other
// settings and their order; creates the file if it does not exist. Errors: those of
// readConfiguration(); the old file is unchanged after any failure.
Result<Ok> saveDeviceSettings(const std::string& path, const std::string& device,
                              const nlohmann::ordered_json& values);

// The numbers as a JSON list, rounded to seven digits.
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
