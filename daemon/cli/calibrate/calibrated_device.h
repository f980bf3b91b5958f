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
  std::string pointer;       // "/devices/2"
  std::string name, driver;  // values in effect: an entry without a name has the name of its kind
  // The settings of the driver in the entry: an object, which may be empty.
  nlohmann::ordered_json own;
  // The baud rate in the entry; 0: the usual rate of the driver.
  nlohmann::ordered_json baud = 0;
  std::string port = {};  // the port in the entry; empty: none
};

using DriverNames = std::span<const char* const>;
// Returns whether `driver` is one of `drivers`.
bool isOneOf(const std::string& driver, DriverNames drivers);

// Finds the device named `name`; if `name` is empty, the first device of this kind with one of
// `drivers`, or the first of this kind if none has one of them. A file that does not exist or has
// no /devices is taken to have merlind's default devices: glove, tracker and ball. Errors:
// kMalformed (the file is not a configuration, or has the form of an earlier version),
// kInvalidArgument (there is no such device, or it is of another kind), kIo.
Result<CalibratedDevice> findDevice(const std::string& file, SampleKind kind,
                                    const std::string& name, DriverNames drivers = {});

// Returns the settings with which merlind would open the device at `port`, with the driver's
// settings in the entry. `baud`: baud rate; 0: that of the entry. Errors: kInvalidArgument (a
// setting is not allowed).
Result<DeviceSettings> settingsOf(const CalibratedDevice& device, const std::string& port,
                                  int baud);

// The line of a device, opened by the calibration itself; no merlind may use the line at the same
// time.
struct OwnLine {
  DeviceSettings settings;
  std::unique_ptr<ByteStream> stream;
};

// Opens the line of the device at `port` or, if `port` is empty, at the port of the entry. Errors:
// those of settingsOf() and io::openPort(); kInvalidArgument (neither names a port).
Result<OwnLine> openOwnLine(const CalibratedDevice& device, const std::string& port, int baud);

// Writes the members of `values` into the driver's settings of the device in the file, and keeps
// all other content and its order; creates the file if it does not exist. Errors: those of
// findDevice() and writeFile(); kInvalidArgument (the device in the file now has another driver
// than `device`). After an error, the file is unchanged.
Result<Ok> saveSettings(const CalibratedDevice& device, SampleKind kind,
                        const nlohmann::ordered_json& values);

// Like saveSettings(), but checks the values with the loader before, and prints what was written.
// Errors: those of settingsOf() and saveSettings().
Result<Ok> saveChecked(const CalibratedDevice& device, SampleKind kind,
                       const nlohmann::ordered_json& values);

// Adds the option --device for the name of a device. `kind`: kind of the device for the help text,
// such as "glove".
void addDeviceOption(Command command, std::string& name, const char* kind);

// Returns the numbers as a JSON list, rounded to seven significant digits.
template <typename T>
nlohmann::ordered_json numbers(const T& values) {
  auto list = nlohmann::ordered_json::array();
  for (const auto v : values) list.push_back(std::stod(fmt::format("{:.7g}", v)));
  return list;
}

}  // namespace merlin::cli
