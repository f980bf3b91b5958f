// merlin calibrate: a device's settings, measured or told, into a configuration.
#include "daemon/cli/calibrate.h"

#include <memory>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "drivers/cyberglove/calibration_files.h"

namespace merlin::cli {

Result<Ok> saveDeviceSettings(const std::string& path, const std::string& device,
                              const nlohmann::ordered_json& values) {
  auto config = nlohmann::ordered_json::object();
  if (const auto file = MappedFile::open(path)) {
    config = nlohmann::ordered_json::parse(file->text(), nullptr, false);
    if (!config.is_object())
      return Error{Errc::kMalformed,
                   path + ": is there and is no JSON object; nothing was changed"};
  } else if (file.error().code != Errc::kNotFound) {
    return file.error();
  }
  auto& devices = config["devices"];
  if (devices.is_null()) devices = nlohmann::ordered_json::object();
  if (!devices.is_object() || (devices.contains(device) && !devices[device].is_object()))
    return Error{Errc::kMalformed, path + ": its /devices is no object; nothing was changed"};
  devices[device].update(values);
  return writeFile(path, config.dump(2) + "\n");
}

namespace {

// Numbers as short as they are exact enough.
template <typename T>
nlohmann::ordered_json numbers(const T& values) {
  auto list = nlohmann::ordered_json::array();
  for (const auto v : values) list.push_back(std::stod(fmt::format("{:.7g}", v)));
  return list;
}

int importGlove(const std::string& input, const std::string& output) {
  const auto file = MappedFile::open(input);
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
  fmt::print("{}: {} joints from {} ({}), the others as shipped\n", output, given, input,
             imported->format);
  return kExitDone;
}

struct TrackerOptions {
  std::string output;
  int station = 1;
  std::vector<double> alignment, boresight, hemisphere;
};

int calibrateTracker(const TrackerOptions& o) {
  auto values = nlohmann::ordered_json::object();
  const auto put = [&](const char* key, const std::vector<double>& list) {
    if (!list.empty()) values[fmt::format(fmt::runtime(key), o.station)] = numbers(list);
  };
  put("alignment{}_cm", o.alignment);
  put("hemisphere{}", o.hemisphere);
  if (!o.boresight.empty()) {
    double square = 0;
    for (const double v : o.boresight) square += v * v;
    if (square < 0.98 || square > 1.02)
      return fail({Errc::kInvalidArgument, "--boresight: is no unit quaternion w x y z"});
    put("boresight{}_wxyz", o.boresight);
  }
  if (values.empty())
    return fail(
        {Errc::kInvalidArgument, "nothing to save: --alignment, --boresight, --hemisphere"});
  if (const auto saved = saveDeviceSettings(o.output, "tracker", values); !saved)
    return fail(saved.error());
  fmt::print("{}: station {}\n", o.output, o.station);
  return kExitDone;
}

struct BallOptions {
  std::string output;
  int translation = 0, rotation = 0, dead_zone = -1;
  std::vector<int> axis_map;
};

int calibrateBall(const BallOptions& o) {
  auto values = nlohmann::ordered_json::object();
  if (o.translation > 0) values["full_scale_translation"] = o.translation;
  if (o.rotation > 0) values["full_scale_rotation"] = o.rotation;
  if (o.dead_zone >= 0) values["dead_zone"] = o.dead_zone;
  if (!o.axis_map.empty()) {
    std::array<bool, 7> seen{};
    for (const int axis : o.axis_map) seen[static_cast<std::size_t>(std::abs(axis))] = true;
    if (seen[0] || std::count(seen.begin(), seen.end(), true) != 6) {
      return fail({Errc::kInvalidArgument,
                   "--axis-map: needs each of 1 to 6 once, negative to turn one round"});
    }
    values["axis_map"] = o.axis_map;
  }
  if (values.empty())
    return fail({Errc::kInvalidArgument, "nothing to save: see merlin calibrate ball --help"});
  if (const auto saved = saveDeviceSettings(o.output, "ball", values); !saved)
    return fail(saved.error());
  fmt::print("{}: ball\n", o.output);
  return kExitDone;
}

}  // namespace

void addCalibrateImport(CLI::App& calibrate, Run& run) {
  const auto input = std::make_shared<std::string>(), output = std::make_shared<std::string>();
  CLI::App* command = calibrate.add_subcommand(
      "import",
      "A glove's calibration that another program wrote: the vendor's .cal, asr_cyberglove's, "
      "Shadow's XML or YAML, VESS's.\nExample: merlin calibrate import right.cal -o merlin.json");
  command->add_option("file", *input, "The calibration")->required();
  command->add_option("-o,--output", *output, "The configuration that it goes into")->required();
  command->callback(
      [input, output, &run] { run = [input, output] { return importGlove(*input, *output); }; });
}

void addCalibrateTracker(CLI::App& calibrate, Run& run) {
  const auto o = std::make_shared<TrackerOptions>();
  CLI::App* command = calibrate.add_subcommand(
      "tracker",
      "Alignment, boresight and hemisphere of a station.\nExample: merlin calibrate tracker "
      "--station 1 --boresight 0.7071 0 0 0.7071 -o merlin.json");
  command->add_option("--station", o->station)->check(CLI::Range(1, 4))->capture_default_str();
  command
      ->add_option("--alignment", o->alignment,
                   "A new origin, a point on its x axis, one on its y axis, centimetres")
      ->expected(9)
      ->check(CLI::Range(-1000.0, 1000.0));
  command
      ->add_option("--boresight", o->boresight,
                   "The orientation that counts as straight ahead, w x y z, as merlin shm dump "
                   "shows it")
      ->expected(4)
      ->check(CLI::Range(-1.0, 1.0));
  command->add_option("--hemisphere", o->hemisphere, "Into the receiver's half of space")
      ->expected(3)
      ->check(CLI::Range(-1.0, 1.0));
  command->add_option("-o,--output", o->output, "The configuration")->required();
  command->callback([o, &run] { run = [o] { return calibrateTracker(*o); }; });
}

void addCalibrateBall(CLI::App& calibrate, Run& run) {
  const auto o = std::make_shared<BallOptions>();
  CLI::App* command = calibrate.add_subcommand(
      "ball",
      "Axis map and sensitivities of the ball.\nExample: merlin calibrate ball --axis-map 1 2 -3 4 "
      "5 -6 --full-scale-translation 6000 -o merlin.json");
  command->add_option("--full-scale-translation", o->translation, "Counts of a full push")
      ->check(CLI::Range(100, 32767));
  command->add_option("--full-scale-rotation", o->rotation, "Counts of a full twist")
      ->check(CLI::Range(100, 32767));
  command->add_option("--dead-zone", o->dead_zone, "Counts that are taken for rest")
      ->check(CLI::Range(0, 99));
  command->add_option("--axis-map", o->axis_map, "For x y z and the turns: the ball's axis 1 to 6")
      ->expected(6)
      ->check(CLI::Range(-6, 6));
  command->add_option("-o,--output", o->output, "The configuration")->required();
  command->callback([o, &run] { run = [o] { return calibrateBall(*o); }; });
}

void addCalibrate(CLI::App& app, Run& run) {
  CLI::App* calibrate =
      app.add_subcommand("calibrate", "A device's calibration, into a configuration.");
  calibrate->require_subcommand(1);
  addCalibrateGlove(*calibrate, run);
  addCalibrateImport(*calibrate, run);
  addCalibrateTracker(*calibrate, run);
  addCalibrateBall(*calibrate, run);
}

}  // namespace merlin::cli
