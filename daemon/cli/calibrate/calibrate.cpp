// merlin calibrate: writes a device's calibration, measured or given, into a configuration.
#include "daemon/cli/calibrate/calibrate.h"

#include <memory>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "drivers/cyberglove/calibration_files.h"

namespace merlin::cli {

Result<nlohmann::ordered_json> readConfiguration(const std::string& path,
                                                 const std::string& device) {
  auto config = nlohmann::ordered_json::object();
  if (const auto file = FileCopy::read(path)) {
    config = nlohmann::ordered_json::parse(file->text(), nullptr, false);
    if (!config.is_object())
      return Error{Errc::kMalformed,
                   path + ": exists and is not a JSON object; nothing was changed"};
  } else if (file.error().code != Errc::kNotFound) {
    return file.error();
  }
  auto& devices = config["devices"];
  if (devices.is_null()) devices = nlohmann::ordered_json::object();
  if (!devices.is_object() || (devices.contains(device) && !devices[device].is_object()))
    return Error{Errc::kMalformed,
                 path + ": /devices, or the device in it, is not an object; nothing was changed"};
  if (!devices.contains(device)) devices[device] = nlohmann::ordered_json::object();
  return config;
}

Result<Ok> saveDeviceSettings(const std::string& path, const std::string& device,
                              const nlohmann::ordered_json& values) {
  auto config = readConfiguration(path, device);
  if (!config) return config.error();
  (*config)["devices"][device].update(values);
  return writeFile(path, config->dump(2) + "\n");
}

namespace {

int importGlove(const std::string& input, const std::string& output) {
  const auto file = FileCopy::read(input);
  if (!file) return fail(file.error());
  const auto imported = cyberglove::importCalibration(file->text());
  if (!imported) return fail({imported.error().code, input + ": " + imported.error().what});
  CybergloveSettings settings;
  int given = 0;
  for (std::size_t i = 0; i < settings.offset.size(); ++i) {
    if (!imported->given[i]) continue;
    settings.offset[i] = imported->offset[i];
    settings.gain[i] = imported->gain[i];
    ++given;
  }
  const auto saved = saveDeviceSettings(
      output, "glove", {{"offset", numbers(settings.offset)}, {"gain", numbers(settings.gain)}});
  if (!saved) return fail(saved.error());
  printOut("{}: {} joints from {} ({}), defaults for the others\n", output, given, input,
           imported->format);
  return kExitDone;
}

}  // namespace

void addCalibrateImport(Command calibrate, Run& run) {
  const auto input = std::make_shared<std::string>(), output = std::make_shared<std::string>();
  Command command = calibrate.subcommand(
      "import",
      "Import a glove's calibration from a file of another program: the vendor's software (.cal), "
      "asr_cyberglove, Shadow (XML or YAML) or VESS.\nExample: merlin calibrate import right.cal "
      "-o merlin.json");
  command.option("file", *input, "The calibration file").required();
  command.option("-o,--output", *output, "The configuration file to write the calibration into")
      .required();
  command.callback(
      [input, output, &run] { run = [input, output] { return importGlove(*input, *output); }; });
}

void addCalibrate(Command app, Run& run) {
  Command calibrate =
      app.subcommand("calibrate", "Calibrate a device and write the result into a configuration.");
  calibrate.requireSubcommand();
  addCalibrateGlove(calibrate, run);
  addCalibrateImport(calibrate, run);
  addCalibrateTracker(calibrate, run);
  addCalibrateBall(calibrate, run);
}

}  // namespace merlin::cli
