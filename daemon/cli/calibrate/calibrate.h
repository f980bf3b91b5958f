// The subcommands of `merlin calibrate`, and helpers that write settings into a configuration file.
#pragma once

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/arguments.h"
#include "daemon/cli/command.h"

namespace merlin::cli {

// Reads the configuration file `path`; returns an empty configuration if the file does not exist.
// Adds the object /devices/DEVICE to the result if it is missing. Errors: kMalformed (the file,
// /devices or /devices/DEVICE is not a JSON object), kIo.
Result<nlohmann::ordered_json> readConfiguration(const std::string& path,
                                                 const std::string& device);

// Copies the members of `values` into /devices/DEVICE of the configuration file `path` and keeps
// all other settings and their order; creates the file if it does not exist. Errors: those of
// readConfiguration() and writeFile(); after an error the old file is unchanged.
Result<Ok> saveDeviceSettings(const std::string& path, const std::string& device,
                              const nlohmann::ordered_json& values);

// The numbers as a JSON list, rounded to seven significant digits.
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
