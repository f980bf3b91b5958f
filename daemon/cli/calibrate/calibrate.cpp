// merlin calibrate: writes the calibration of a device, measured or given by options, into a
// configuration.
#include "daemon/cli/calibrate/calibrate.h"

#include <memory>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/calibrate/calibrated_device.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "drivers/cyberglove/calibration_files.h"

namespace merlin::cli {

namespace {

struct ImportOptions {
  std::string input, output, device;
};

int importGlove(const ImportOptions& o) {
  const auto device = findDevice(o.output, SampleKind::kGlove, o.device);
  if (!device) return fail(device.error());
  const auto file = FileCopy::read(o.input);
  if (!file) return fail(file.error());
  const auto imported = cyberglove::importCalibration(file->text());
  if (!imported) return fail({imported.error().code, o.input + ": " + imported.error().what});
  CybergloveSettings settings;
  int given = 0;
  for (std::size_t i = 0; i < settings.offset.size(); ++i) {
    if (!imported->given[i]) continue;
    settings.offset[i] = imported->offset[i];
    settings.gain[i] = imported->gain[i];
    ++given;
  }
  const auto saved =
      saveSettings(*device, SampleKind::kGlove,
                   {{"offset", numbers(settings.offset)}, {"gain", numbers(settings.gain)}});
  if (!saved) return fail(saved.error());
  printOut("{}: {}, {} joints from {} ({}), defaults for the others\n", o.output, device->name,
           given, o.input, imported->format);
  return kExitDone;
}

}  // namespace

void addCalibrateImport(Command calibrate, Run& run) {
  const auto o = std::make_shared<ImportOptions>();
  Command command = calibrate.subcommand(
      "import",
      "Import a glove's calibration from a file of another program: the vendor's software (.cal), "
      "asr_cyberglove, Shadow (XML or YAML) or VESS.\nExample: merlin calibrate import right.cal "
      "-o merlin.json");
  command.option("file", o->input, "The calibration file").required();
  command.option("-o,--output", o->output, "The configuration file to write the calibration into")
      .required();
  addDeviceOption(command, o->device, "glove");
  command.callback([o, &run] { run = [o] { return importGlove(*o); }; });
}

void addCalibrate(Command app, Run& run) {
  Command calibrate =
      app.subcommand("calibrate", "Calibrate a device and write the result into a configuration.");
  calibrate.requireSubcommand();
  addCalibrateGlove(calibrate, run);
  addCalibrateImport(calibrate, run);
  addCalibrateTracker(calibrate, run);
  addCalibrateBall(calibrate, run);
  addCalibratePad(calibrate, run);
  addCalibrateTouch(calibrate, run);
}

}  // namespace merlin::cli
