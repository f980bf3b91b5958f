// merlin emulate: emulates a device on a pseudo-terminal, to run a wall without hardware.
#include <cerrno>
#include <memory>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/unique_fd.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/stop_signals.h"
#include "drivers/emulate/emulator.h"
#include "drivers/io/pty_master.h"

namespace merlin::cli {
namespace {

struct EmulateOptions {
  std::string device, link, script = "visit", model;
  int baud = 0;
  int garbage_every = 0;
  std::uint64_t seed = 1;
  std::int64_t epoch_ns = 0;
  bool step = false;
};

// Input of the person who runs the emulator: the descriptor `stop_fd` ends the emulation, `step_fd`
// starts the script's next phase.
struct Commands {
  int stop_fd, step_fd;  // -1: none; poll() ignores it
  std::size_t phases;    // number of phases of the script
  // Index of the current phase, from 0; it goes on counting when the script repeats.
  std::size_t& phase;
};

// Reads standard input: each line starts the next phase.
void readPhaseSteps(Commands& commands) {
  char text[256];
  const ssize_t n = ::read(commands.step_fd, text, sizeof text);
  if (n <= 0) commands.step_fd = -1;  // end of input
  for (ssize_t i = 0; i < n; ++i) {
    if (text[i] != '\n') continue;
    ++commands.phase;
    printOut("phase {} of {}\n", commands.phase % commands.phases + 1, commands.phases);
    std::fflush(stdout);
  }
}

// Runs the emulator until a signal arrives; returns the exit status. Bytes that the other side does
// not read are lost, as on a serial line.
int serve(const io::PtyMaster& line, emulate::Emulator& device, const Clock& clock,
          Commands commands) {
  std::byte received[256];
  std::string out;
  for (;;) {
    device.advance(clock.now(), out);
    if (!out.empty()) {
      (void)!::write(line.fd(), out.data(), out.size());
      out.clear();
    }
    const Duration until = std::max<Duration>(device.nextDue() - clock.now(), Duration::zero());
    const timespec limit{until / std::chrono::seconds(1),
                         (until % std::chrono::seconds(1)).count()};
    pollfd fds[] = {
        {line.fd(), POLLIN, 0}, {commands.stop_fd, POLLIN, 0}, {commands.step_fd, POLLIN, 0}};
    if (::ppoll(fds, 3, &limit, nullptr) < 0 && errno != EINTR) return kExitFailed;
    if (fds[1].revents != 0) return kExitDone;
    if (fds[2].revents != 0) readPhaseSteps(commands);
    if (fds[0].revents == 0) continue;
    const ssize_t n = ::read(line.fd(), received, sizeof received);
    if (n > 0) device.receive(std::span(received, static_cast<std::size_t>(n)), clock.now());
  }
}

int emulateDevice(const EmulateOptions& options) {
  const emulate::EmulatorEntry* entry = emulate::findEmulator(options.device);
  const emulate::MotionScript* script = emulate::findMotionScript(options.script);
  if (!entry || !script)
    return fail({Errc::kInvalidArgument, "no such device or script"});  // CLI11 has checked both
  emulate::EmulatorSettings settings;
  settings.baud = options.baud > 0 ? options.baud : entry->baud;
  settings.model = options.model;
  settings.seed = options.seed;
  settings.garbage_every = options.garbage_every;
  if (!emulate::hasModel(*entry, options.model)) {
    return fail({Errc::kInvalidArgument, fmt::format("--model {}: models of {} are {}",
                                                     options.model, entry->name, entry->models)});
  }
  const UniqueFd stop = stopSignals();
  const SystemClock clock;
  const auto line = io::PtyMaster::open(options.link);
  if (!line) return fail(line.error());
  const Timestamp start = options.epoch_ns > 0 ? fromNanoseconds(options.epoch_ns) : clock.now();
  std::size_t phase = 0;
  emulate::MotionScript played = *script;
  if (options.step) played.held = &phase;
  const auto device = entry->make(settings, played, start);
  printOut("{} on pty:{}\n", entry->name, options.link.empty() ? line->slavePath() : options.link);
  std::fflush(stdout);
  return serve(*line, *device, clock,
               {stop.get(), options.step ? STDIN_FILENO : -1, script->phases.size(), phase});
}

}  // namespace

void addEmulate(Command app, Run& run) {
  const auto options = std::make_shared<EmulateOptions>();
  std::vector<std::string> devices, scripts;
  std::string help = "Emulate a device, with its serial protocol, on a pseudo-terminal.\nDevices:";
  for (const auto& e : emulate::emulators()) {
    devices.emplace_back(e.name);
    help += fmt::format("\n  {:11} {} (models {})", e.name, e.help, e.models);
  }
  help += "\nScripts:";
  for (const auto& s : emulate::motionScripts()) {
    scripts.emplace_back(s.name);
    help += fmt::format("\n  {:11} {}", s.name, s.help);
  }
  Command command =
      app.subcommand("emulate", help + "\nExample: merlin emulate spaceball --link /tmp/ball");
  command.option("device", options->device, "Device to emulate").required().oneOf(devices);
  command.option("--link", options->link,
                 "Path of a symbolic link to create, which points to the pseudo-terminal");
  command.option("--script", options->script, "What the emulated person does")
      .oneOf(scripts)
      .showDefault();
  command.flag("--step", options->step,
               "Each phase of the script lasts until Enter is pressed, instead of its set time");
  command.option("--model", options->model,
                 "Model of the device, from the list above; the default is the first");
  command
      .option("--baud", options->baud,
              "Speed of the line in bits per second; the default depends on the device")
      .baud();
  command
      .option("--garbage-every", options->garbage_every,
              "Number of records between two bursts of random bytes on the line; 0: no bursts")
      .range(0, 1'000'000'000)
      .showDefault();
  command.option("--seed", options->seed, "Seed of the random numbers for noise and bursts")
      .showDefault();
  command
      .option("--epoch-ns", options->epoch_ns,
              "Start time of the script in nanoseconds of CLOCK_MONOTONIC, to synchronise several "
              "emulators; the default is now")
      .positive();
  command.callback([options, &run] { run = [options] { return emulateDevice(*options); }; });
}

}  // namespace merlin::cli
