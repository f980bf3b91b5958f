#include "daemon/configuration.h"

#include <filesystem>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "daemon/alarms/child_program.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/devices/device_checks.h"
#include "daemon/status/curve.h"
#include "daemon/status/run_directory.h"
#include "daemon/wall/wall_checks.h"

namespace merlin {
namespace {

constexpr const char* kCannot = "cannot be used: ";
constexpr std::size_t kMostSocketName = sizeof sockaddr_un::sun_path - 1;

template <typename T>
void take(const Result<T>& result, const char* pointer, LoadedSettings& loaded) {
  if (!result) loaded.addFinding(pointer, kCannot + result.error().what);
}

// Checks the limit on open files, because libzmq aborts the process when it runs out of file
// descriptors.
void checkDescriptors(LoadedSettings& loaded) {
  constexpr rlim_t kLeast = 256;  // the servers accept up to 216 connections
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_max >= kLeast) return;
  loaded.add({false, 0, "",
              fmt::format("this process may open {} files at once, but merlind needs "
                          "{}: raise the limit (ulimit -n, LimitNOFILE=)",
                          limit.rlim_max, kLeast)});
}

void checkRunDirectory(LoadedSettings& loaded) {
  const std::string& path = loaded.settings.run_directory;
  if (const auto good = status::checkRunDirectory(path); !good)
    return take(good, "/run_directory", loaded);
  if (path.empty()) return;
  // Length of the longest socket name in the folder.
  const std::size_t longest = path.size() + 1 + loaded.settings.instance.size() +
                              std::string_view("-devices.command.network.inner").size();
  if (longest > kMostSocketName) {
    return loaded.addFinding(
        "/run_directory",
        fmt::format("is too long: the names of sockets in it would have {} bytes; "
                    "at most {} are allowed",
                    longest, kMostSocketName));
  }
  take(checkFolder(path), "/run_directory", loaded);
}

// Checks the name of the socket for libspnav. The server replaces an existing socket of this name,
// but no other kind of file.
void checkSpnavSocket(LoadedSettings& loaded) {
  constexpr const char* kPointer = "/serve/spnav_socket";
  const std::string& path = loaded.settings.serve.spnav_socket;
  if (path.empty()) return;
  if (path.size() > kMostSocketName) {
    return loaded.addFinding(kPointer, fmt::format("has {} bytes; a socket's name has at most {}",
                                                   path.size(), kMostSocketName));
  }
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0 && !S_ISSOCK(status.st_mode)) {
    return loaded.addFinding(kPointer, fmt::format("{}{}: is not a socket and is not replaced; "
                                                   "choose another name, or remove the file",
                                                   kCannot, path));
  }
  const std::string folder = std::filesystem::path(path).parent_path().string();
  take(checkWritableFolder(folder.empty() ? "." : folder), kPointer, loaded);
}

// Checks that the state file can be written. If it cannot, a start continues with a warning (see
// StateKeeper), but a reload is refused.
void checkStateWritable(Reading reading, const char* pointer, LoadedSettings& loaded) {
  const std::string& path = loaded.settings.state_file;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  auto usable = checkFolder(folder.empty() ? "." : folder);
  std::error_code error;
  if (usable && std::filesystem::exists(path, error)) usable = checkWritable(path);
  if (usable || reading == Reading::kAgain) return take(usable, pointer, loaded);
  loaded.add(
      {true, loaded.lineOf(pointer), pointer,
       kCannot + usable.error().what + "; what people change is not kept until it can be written"});
}

// Checks that the state file can be written and that it is none of the files that are read.
void checkStateFile(const std::string& configuration, Reading reading, LoadedSettings& loaded) {
  constexpr const char* kPointer = "/state_file";
  const std::string& path = loaded.settings.state_file;
  if (path.empty()) return;
  std::error_code error;
  if (std::filesystem::equivalent(configuration, path, error))
    return loaded.addFinding(kPointer,
                             "names the configuration itself, which merlind never writes");
  for (const LoadedSettings::Source& source : loaded.sources) {
    if (source.file.empty() || !std::filesystem::equivalent(source.file, path, error)) continue;
    return loaded.addFinding(
        kPointer, fmt::format("names {}, a file of the configuration, which merlind never writes",
                              source.file));
  }
  wall::checkReplacesNothing(loaded, path, kPointer);
  checkStateWritable(reading, kPointer, loaded);
}

// Checks that the host of the address is '*' or an IPv4 address, to which a socket can be bound.
void checkBindable(const std::string& endpoint, const char* pointer, LoadedSettings& loaded) {
  constexpr std::string_view kTcp = "tcp://";
  if (!endpoint.starts_with(kTcp)) return;  // already reported by the loader
  const std::string host = endpoint.substr(kTcp.size(), endpoint.rfind(':') - kTcp.size());
  in_addr address{};
  if (host == "*" || ::inet_pton(AF_INET, host.c_str(), &address) == 1) return;
  loaded.addFinding(
      pointer, fmt::format("{}{} is neither * nor an IPv4 address of this machine", kCannot, host));
}

void checkSamples(LoadedSettings& loaded) {
  const ServeSettings& s = loaded.settings.serve;
  if (s.samples_endpoint.empty()) return;
  checkBindable(s.samples_endpoint, "/serve/samples_endpoint", loaded);
  if (!s.samples_keys.empty())
    take(status::readKeyPair(s.samples_keys), "/serve/samples_keys", loaded);
  if (!s.samples_clients.empty())
    take(status::readPublicKeys(s.samples_clients), "/serve/samples_clients", loaded);
}

// Checks the addresses and keys of the sockets for other machines, of this process's roles only.
void checkNetworkCommands(const DaemonOptions& options, LoadedSettings& loaded) {
  const ServeSettings& s = loaded.settings.serve;
  const bool wall = options.wall && !s.wall_endpoint.empty();
  const bool devices = options.devices && !s.devices_endpoint.empty();
  const bool topics = options.wall && !s.wall_topics_endpoint.empty();
  if (!wall && !devices && !topics) return;
  if (wall) checkBindable(s.wall_endpoint, "/serve/wall_endpoint", loaded);
  if (devices) checkBindable(s.devices_endpoint, "/serve/devices_endpoint", loaded);
  if (topics) checkBindable(s.wall_topics_endpoint, "/serve/wall_topics_endpoint", loaded);
  if (!s.commands_keys.empty())
    take(status::readKeyPair(s.commands_keys), "/serve/commands_keys", loaded);
  if (!s.commands_clients.empty())
    take(status::readPublicKeys(s.commands_clients), "/serve/commands_clients", loaded);
  if (!s.commands_readers.empty())
    take(status::readPublicKeys(s.commands_readers), "/serve/commands_readers", loaded);
}

void checkInput(const DaemonOptions& options, LoadedSettings& loaded) {
  const InputSettings& input = loaded.settings.wall.input;
  if (input.endpoint.empty()) return;
  if (options.devices) {
    loaded.addFinding(
        "/wall/input/endpoint",
        "names another machine's devices, but this process reads devices itself: run it with "
        "--role wall");
  }
  if (!input.keys.empty()) take(status::readKeyPair(input.keys), "/wall/input/keys", loaded);
}

// Adds a finding that does not make the configuration invalid, because a role may be switched off:
// its process then waits for a configuration that switches it on.
void addNothingToDo(LoadedSettings& loaded, const char* pointer, const char* what) {
  loaded.add({true, loaded.lineOf(pointer), pointer, what});
}

void checkPage(LoadedSettings& loaded) {
  const PageSettings& page = loaded.settings.page;
  if (page.enabled || page.metrics) return;
  addNothingToDo(loaded, "/page/enabled",
                 "is false, and so is /page/metrics: the role page has nothing to serve");
}

// A program that is missing does not make the configuration invalid: the other alarms work, and the
// program may be installed later.
void checkAlarms(LoadedSettings& loaded) {
  const std::vector<AlarmSettings>& alarms = loaded.settings.alarms;
  if (alarms.empty())
    addNothingToDo(loaded, "/alarms", "is empty: the role alarms has no program to start");
  for (std::size_t i = 0; i < alarms.size(); ++i) {
    const std::vector<std::string>& run = alarms[i].run;
    if (run.empty() || !run.front().starts_with('/')) continue;  // the loader has reported it
    const auto usable = alarms::checkProgram(run.front());
    if (usable) continue;
    const std::string at = fmt::format("/alarms/{}/run/0", i);
    loaded.add({true, loaded.lineOf(at), at,
                fmt::format("{}{}; until it can be, this alarm tells nobody: put the program, "
                            "or its interpreter, there, and let everybody execute it (chmod 755)",
                            kCannot, usable.error().what),
                true});
  }
}

}  // namespace

Configuration readConfiguration(const std::string& file, const DaemonOptions& options,
                                Reading reading) {
  Configuration read{loadSettingsFile(file), {}, file, {}};
  LoadedSettings& loaded = read.loaded;
  // The files could not be read or parsed at all.
  if (!loaded.parsed) return read;
  checkDescriptors(loaded);
  checkRunDirectory(loaded);
  if (options.page) checkPage(loaded);
  if (options.alarms) checkAlarms(loaded);
  if (options.devices) {
    devices::checkPostures(loaded);
    devices::checkGestures(loaded);
    devices::checkKeys(loaded);
    devices::checkPasswords(loaded);
    if (!options.emulate) devices::checkPorts(loaded);
    checkSamples(loaded);
  }
  const bool mirrors = options.wall && !loaded.settings.wall.input.endpoint.empty();
  if (options.devices || mirrors) checkSpnavSocket(loaded);
  checkNetworkCommands(options, loaded);
  if (options.wall) {
    checkInput(options, loaded);
    checkStateFile(file, reading, loaded);
    if (reading == Reading::kStart) wall::checkRenderer(loaded);
    wall::checkOutputs(loaded, reading == Reading::kStart);
    wall::checkPlaylist(loaded);
    if (reading == Reading::kStart) read.contents = wall::readContents(loaded);
  }
  loaded.sortFindings();
  return read;
}

std::vector<std::string> findingLines(const std::string& file, const LoadedSettings& loaded) {
  std::vector<std::string> lines;
  for (const Finding& finding : loaded.findings) lines.push_back(toText(file, finding));
  if (loaded.left_out > 0)
    lines.push_back(fmt::format("{}: and {} more findings", oneLine(file), loaded.left_out));
  return lines;
}

}  // namespace merlin
