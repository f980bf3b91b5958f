// merlin record: records the bytes on a device's line into a file. merlin replay: replays the file.
#include <algorithm>
#include <csignal>
#include <ctime>
#include <memory>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>

#include "config/loader.h"
#include "daemon/base/files.h"
#include "daemon/base/log.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/stop_signals.h"
#include "drivers/io/open_stream.h"
#include "drivers/io/pty_master.h"
#include "drivers/io/recording_stream.h"
#include "drivers/io/replay_stream.h"
#include "drivers/registry.h"

namespace merlin::cli {
namespace {

struct LineRecordOptions {
  std::string port, device, config, output;
  int baud = 0;
  double seconds = 0;
};

// Stores all bytes that are read and written, with their times.
class Recording final : public ByteTap {
 public:
  explicit Recording(Timestamp start) : start_(start) {}
  void opened(Timestamp) noexcept override {}
  void heard(Timestamp at, std::span<const std::byte> bytes) noexcept override {
    add(at, false, bytes);
  }
  void said(Timestamp at, std::span<const std::byte> bytes) noexcept override {
    add(at, true, bytes);
  }

  io::Transcript transcript;

 private:
  void add(Timestamp at, bool to_device, std::span<const std::byte> bytes) {
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    transcript.chunks.push_back({at - start_, to_device, std::string(text, bytes.size())});
  }
  Timestamp start_;
};

// A sample sink that discards all samples.
struct Nowhere final : SampleSink {
  void publish(const GloveSample&) noexcept override {}
  void publish(const TrackerSample&) noexcept override {}
  void publish(const BallSample&) noexcept override {}
  void publish(const TouchSample&) noexcept override {}
};

// Reads the line until `end`, until `stop_fd` is readable, or until the line fails, which is
// printed. If `device` is not null, its driver opens and polls the device; otherwise the line is
// only read. Returns the identity of the device. Errors: those of Device::open().
Result<std::string> listen(ByteStream& line, Device* device, Timestamp end, int stop_fd) {
  const SystemClock clock;
  std::string identity = "not known";
  if (device) {
    const auto opened = device->open(line);
    if (!opened) return opened.error();
    identity = *opened;
  }
  std::byte buffer[256];
  while (clock.now() < end) {
    if (stopArrived(stop_fd)) break;
    Result<Ok> heard = Ok{};
    if (device) {
      heard = device->poll(line);
    } else if (const auto got = line.read(buffer, std::chrono::milliseconds(250)); !got) {
      heard = got.error();
    }
    if (heard || heard.error().code == Errc::kTimeout) continue;
    printError("merlin: the line ended: {}\n", heard.error().what);
    break;
  }
  return identity;
}

std::vector<std::string> driverNames() {
  std::vector<std::string> names;
  for (const DriverEntry& entry : drivers()) names.emplace_back(entry.name);
  return names;
}

// Returns the settings of the device with this name in a configuration. Errors: kInvalidArgument
// (there is none), kMalformed (the configuration is not valid).
Result<DeviceSettings> configuredDevice(const std::string& file, const std::string& name) {
  const LoadedSettings loaded = loadSettingsFile(file);
  const auto fault = std::ranges::find(loaded.findings, false, &Finding::adjusted);
  if (fault != loaded.findings.end())
    return Error{
        Errc::kMalformed,
        toText(file, *fault) +
            fmt::format("; correct it first (`merlind --check-config {}` lists all faults)", file)};
  const auto& list = loaded.settings.devices.list;
  const auto found = std::ranges::find(list, name, &DeviceSettings::name);
  if (found != list.end()) return *found;
  std::vector<std::string> names;
  for (const DeviceSettings& device : list) names.push_back(device.name);
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: /devices has no device named \"{}\"; its devices: {}", file, name,
                           names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")))};
}

// Returns the settings for the device to record: those in the configuration, or the defaults of the
// driver that the options name; without either, the line is only read. The options override port
// and baud rate. Errors: kInvalidArgument, those of configuredDevice().
Result<DeviceSettings> recordedDevice(const LineRecordOptions& options) {
  DeviceSettings device;
  if (!options.config.empty()) {
    const auto found = configuredDevice(options.config, options.device);
    if (!found) return found.error();
    device = *found;
  } else if (const DriverEntry* const driver = findDriver(options.device)) {
    device.line.driver = driver->name;
    device.line.baud = driver->baud;
  } else if (!options.device.empty()) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("there is no driver \"{}\"; the drivers are {}. For a device of a "
                             "configuration by its name, add --config FILE",
                             options.device, fmt::join(driverNames(), ", "))};
  } else {
    device.line.baud = kUsualBaud;
  }
  if (!options.port.empty()) device.line.port = options.port;
  if (options.baud > 0) device.line.baud = options.baud;
  if (!device.line.port.empty()) return device;
  return Error{
      Errc::kInvalidArgument,
      options.config.empty()
          ? "no port is given: name one, such as serial:/dev/ttyUSB0, or a device that has "
            "one by --config FILE --device NAME"
          : fmt::format("{}: the device \"{}\" has no port: give one, such as "
                        "serial:/dev/ttyUSB0",
                        options.config, options.device)};
}

int recordLine(const LineRecordOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  const UniqueFd stop = stopSignals();
  const auto recorded = recordedDevice(options);
  if (!recorded) return fail(recorded.error());
  const auto address = parsePort(recorded->line.port);
  if (!address) return fail(address.error());
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  const DriverEntry* const driver = findDriver(recorded->line.driver);
  const int baud = recorded->line.baud;
  auto line = io::openPort(*address, baud);
  if (!line) return fail(line.error());
  const SystemClock clock;
  const Timestamp start = clock.now();
  Recording recording(start);
  io::RecordingStream stream(*std::move(line), recording, clock);
  Nowhere nowhere;
  const auto device = driver ? driver->make(recorded->own, clock, nowhere) : nullptr;
  const Timestamp end =
      options.seconds > 0 ? start + fromSeconds(options.seconds) : Timestamp::max();
  const auto identity = listen(stream, device.get(), end, stop.get());
  recording.transcript.header = {
      {"device", identity ? *identity : "no device answered: " + identity.error().what},
      {"driver", driver ? driver->name : "none, the line was only read"},
      {"serial", address->hasSpeed() && baud > 0 ? fmt::format("{} 8N1", baud) : "none"},
      {"synthetic", "not known: from " + recorded->line.port},
      {"by", "merlin record"},
      {"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))}};
  const auto written = writeFile(options.output, io::formatTranscript(recording.transcript));
  if (!written) return fail(written.error());
  std::size_t bytes = 0;
  for (const auto& chunk : recording.transcript.chunks) bytes += chunk.bytes.size();
  printOut("{}: {} bytes in {} pieces\n", options.output, bytes,
           recording.transcript.chunks.size());
  return identity ? kExitDone : fail(identity.error());
}

struct ReplayOptions {
  std::string file, link;
  bool loop = false;
};

// Plays the transcript once on the line. Returns false if `stop_fd` became readable or an error
// ended the replay early.
bool serveOnce(const io::PtyMaster& line, const io::Transcript& transcript, const Clock& clock,
               int stop_fd) {
  io::Player player(transcript, clock.now());
  std::byte received[256];
  std::string out;
  while (!player.ended()) {
    player.advance(clock.now(), out);
    if (!out.empty()) (void)!::write(line.fd(), out.data(), out.size());
    out.clear();
    const Duration wait = std::max<Duration>(player.nextDue() - clock.now(), Duration::zero());
    const timespec limit{wait / std::chrono::seconds(1), (wait % std::chrono::seconds(1)).count()};
    pollfd fds[] = {{line.fd(), POLLIN, 0}, {stop_fd, POLLIN, 0}};
    if (player.ended()) return true;
    if (::ppoll(fds, 2, &limit, nullptr) < 0 && errno != EINTR) return false;
    if (fds[1].revents != 0) return false;
    if (fds[0].revents == 0) continue;
    const ssize_t n = ::read(line.fd(), received, sizeof received);
    if (n > 0) player.hostSaid(static_cast<std::size_t>(n), clock.now());
  }
  return true;
}

int replay(const ReplayOptions& options) {
  const UniqueFd stop = stopSignals();
  const auto transcript = io::readTranscript(options.file);
  if (!transcript) return fail(transcript.error());
  const auto line = io::PtyMaster::open(options.link);
  if (!line) return fail(line.error());
  printOut("{} on pty:{}\n", options.file, options.link.empty() ? line->slavePath() : options.link);
  std::fflush(stdout);
  const SystemClock clock;
  do {
    if (!serveOnce(*line, *transcript, clock, stop.get())) return kExitDone;
  } while (options.loop);
  pollfd item{stop.get(), POLLIN, 0};
  ::poll(&item, 1, 200);  // lets the other side read the last bytes before the line closes
  return kExitDone;
}

}  // namespace

void addRecord(Command app, Run& run) {
  const auto options = std::make_shared<LineRecordOptions>();
  const std::string device_help = fmt::format(
      "Driver that sets up and polls the device ({}), with its usual settings; with --config the "
      "name of a device in that file, with the settings that it has there. Without --device, the "
      "line is only read",
      fmt::join(driverNames(), ", "));
  Command command = app.subcommand(
      "record",
      "Record the bytes on a device's line as a transcript.\nIf a daemon has opened the line, use "
      "merlin flight instead.\nExample: merlin record pty:/tmp/ball --device spaceball -o "
      "ball.bytes; merlin record --config merlin.json --device left -o left.bytes");
  command.option("port", options->port,
                 "Port of the device: serial:/dev/..., pty:PATH, tcp://HOST:PORT, udp:PORT, "
                 "unix:PATH or evdev:/dev/input/...; the default is that of the device in the "
                 "configuration");
  command.option("-o,--output", options->output, "File to write the transcript into (text)")
      .required();
  command.option("--device", options->device, device_help.c_str()).typeName("DRIVER|NAME");
  command.option("-c,--config", options->config, "The configuration that has the device")
      .typeName("CONFIG");
  command
      .option("--baud", options->baud,
              "Speed of the line in bits per second; the default is that of the device, 38400 if "
              "none is named")
      .baud();
  command
      .option("--seconds", options->seconds,
              "Duration in seconds; the default is until interrupted")
      .seconds();
  command.callback([options, &run] {
    if (!options->config.empty() && options->device.empty()) lacks("--device NAME");
    run = [options] { return recordLine(*options); };
  });
}

void addReplay(Command app, Run& run) {
  const auto options = std::make_shared<ReplayOptions>();
  Command command = app.subcommand(
      "replay",
      "Replay a transcript on a pseudo-terminal with its original timing. Where the transcript has "
      "bytes that the host sent, waits up to two seconds until the host has sent as "
      "many.\nExample: merlin replay ball.bytes --link "
      "/tmp/ball");
  command.option("file", options->file, "The transcript file").required();
  command.option("--link", options->link,
                 "Path of a symbolic link to create, which points to the pseudo-terminal");
  command.flag("--loop", options->loop, "Repeat until interrupted");
  command.callback([options, &run] { run = [options] { return replay(*options); }; });
}

}  // namespace merlin::cli
