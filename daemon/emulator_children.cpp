#include "daemon/emulator_children.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/base/clock.h"
#include "daemon/devices/device_places.h"
#include "drivers/emulate/names.h"

namespace merlin {
namespace {

// Returns the path of the program merlin, which is in the same folder as this program. Errors: kIo.
Result<std::string> merlinProgram() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto program = self.parent_path() / "merlin";
  if (!error && ::access(program.c_str(), X_OK) == 0) return program.string();
  return Error{Errc::kIo,
               fmt::format("{}: does not exist or cannot be executed, and --emulate needs it",
                           program.string())};
}

Result<pid_t> spawn(const std::vector<std::string>& arguments) {
  const pid_t parent = ::getpid();
  auto child = startChild();
  if (!child || *child != 0) return child;
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // the emulator ends with merlind
  if (::getppid() != parent) ::_exit(1);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

// Sets the device's port to pty:PATH, unless it has this form already, and returns PATH.
std::string placeLine(DeviceSettings& device, const std::string& instance,
                      const std::string& run_directory) {
  constexpr std::string_view kPty = "pty:";
  std::string& port = device.line.port;
  if (!port.starts_with(kPty))
    port = fmt::format("pty:{}/{}-{}.pty", run_directory, instance, device.name);
  return port.substr(kPty.size());
}

// Returns the highest station number of this tracker that a hand or the head uses, at least 1. The
// emulated Fastrak has that many receivers.
int stationsOf(const Settings& settings, const std::string& tracker) {
  int highest = 1;
  const auto use = [&](const std::string& name, int station) {
    const DevicesSettings& devices = settings.devices;
    const auto place = devices::placeOf(devices, SampleKind::kTracker, name);
    if (place == devices::placeOf(devices, SampleKind::kTracker, tracker))
      highest = std::max(highest, station);
  };
  for (const HandSettings& hand : settings.devices.hands) use(hand.tracker, hand.station);
  use(settings.wall.stereo.head.tracker, settings.wall.stereo.head.station);
  return highest;
}

// Returns the command line of `merlin emulate` for this device.
std::vector<std::string> emulateCommand(const std::string& program, const Settings& settings,
                                        const DeviceSettings& device, const std::string& link) {
  const LineSettings& line = device.line;
  std::vector<std::string> command = {program,
                                      "emulate",
                                      line.driver,
                                      "--link",
                                      link,
                                      "--script",
                                      settings.devices.script,
                                      "--baud",
                                      std::to_string(line.baud)};
  if (line.driver == "fastrak") {
    command.insert(command.end(), {"--model", std::to_string(stationsOf(settings, device.name))});
  }
  return command;
}

}  // namespace

Result<EmulatorChildren> EmulatorChildren::start(Settings& settings,
                                                 const std::string& run_directory) {
  const auto program = merlinProgram();
  if (!program) return program.error();
  EmulatorChildren started;
  const auto epoch = std::to_string(toNanoseconds(SystemClock().now()));
  for (DeviceSettings& device : settings.devices.list) {
    const LineSettings& line = device.line;
    if (!emulate::isEmulated(line.driver)) continue;
    const std::string link = placeLine(device, settings.instance, run_directory);
    std::vector<std::string> command = emulateCommand(*program, settings, device, link);
    command.insert(command.end(), {"--epoch-ns", epoch});
    const auto child = spawn(command);
    if (!child)
      return Error{child.error().code,
                   fmt::format("the emulator of {}: {}", device.name, child.error().what)};
    started.children_.push_back({{device.name, line.driver}, *child});
  }
  return started;
}

EmulatorChildren::~EmulatorChildren() {
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
  for (const Child& child : children_) waitForChild(child.pid);
}

std::vector<EmulatorChildren::Emulated> EmulatorChildren::takeEnded() {
  std::vector<Emulated> ended;
  std::erase_if(children_, [&](const Child& child) {
    if (::waitpid(child.pid, nullptr, WNOHANG) != child.pid) return false;
    ended.push_back(child.emulated);
    return true;
  });
  return ended;
}

}  // namespace merlin
