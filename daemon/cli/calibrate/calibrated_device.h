// Finds the device that a calibration is for in a configuration file, and writes the measured
// values into its entry.
#pragma once

#include <memory>
#include <span>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/settings.h"
#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "drivers/port/byte_stream.h"
#include "drivers/port/samples.h"

namespace merlin::cli {

// An entry of the list /devices.
struct CalibratedDevice {
  std::string file;
  std::string pointer;         // "/devices/2"
  std::string name, driver;    // the values in effect: an entry without a name has that of its kind
  nlohmann::ordered_json own;  // the entry's settings of its driver: an object, which may be empty
  nlohmann::ordered_json baud = 0;  // the entry's speed of the line; 0: the driver's usual one
  std::string port = {};            // the entry's; empty: it has none
};

using DriverNames = std::span<const char* const>;
bool isOneOf(const std::string& driver, DriverNames drivers);

// Finds the device named `name`; if `name` is empty, the first device of this kind with one of
// `drivers`, or the first of this kind if none has one of them. A file that does not exist or has
// no /devices has merlind's default devices: glove, tracker and ball. Errors: kMalformed (the file
// is no configuration, or one of an earlier form), kInvalidArgument (there is no such device, or it
// is of another kind), kIo.
Result<CalibratedDevice> findDevice(const std::string& file, SampleKind kind,
                                    const std::string& name, DriverNames drivers = {});

// The device as merlind would open it at `port`: with the entry's settings of its driver, and its
// speed unless `baud` is another one than 0. Errors: kInvalidArgument (one of them is not allowed).
Result<DeviceSettings> settingsOf(const CalibratedDevice& device, const std::string& port,
                                  int baud);

// A device's line that the calibration itself has opened; no merlind may use it meanwhile.
struct OwnLine {
  DeviceSettings settings;
  std::unique_ptr<ByteStream> stream;
};

// Opens the device's line at `port`, or at the entry's port if that is empty. Errors: those of
// settingsOf() and io::openPort(); kInvalidArgument (neither names a port).
Result<OwnLine> openOwnLine(const CalibratedDevice& device, const std::string& port, int baud);

// Copies the members of `values` into the device's settings of its driver, and keeps everything
// else in the file, and its order; creates the file if it does not exist. Errors: those of
// findDevice() and writeFile(); kInvalidArgument (the file has changed meanwhile: the device has
// another driver there). After an error the old file is unchanged.
Result<Ok> saveSettings(const CalibratedDevice& device, SampleKind kind,
                        const nlohmann::ordered_json& values);

// The same, but first has the loader check the values; prints what was written. Errors also: those
// of settingsOf().
Result<Ok> saveChecked(const CalibratedDevice& device, SampleKind kind,
                       const nlohmann::ordered_json& values);

// Adds the option --device for the name of a device. `kind`: "glove".
void addDeviceOption(Command command, std::string& name, const char* kind);

// The numbers as a JSON list, rounded to seven significant digits.
template <typename T>
nlohmann::ordered_json numbers(const T& values) {
  auto list = nlohmann::ordered_json::array();
  for (const auto v : values) list.push_back(std::stod(fmt::format("{:.7g}", v)));
  return list;
}

}  // namespace merlin::cli
