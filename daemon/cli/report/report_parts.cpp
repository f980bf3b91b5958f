#include "daemon/cli/report/report_parts.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/effective.h"
#include "config/writer.h"
#include "daemon/base/files.h"
#include "daemon/cli/print.h"
#include "daemon/cli/report/machine.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/status_text.h"
#include "daemon/cli/wall/trace.h"
#include "daemon/shm/segment.h"
#include "daemon/state/state_folder.h"
#include "render/image/png_writer.h"
#include "render/out/shared_frame.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

constexpr std::size_t kMega = 1 << 20;
constexpr std::size_t kMostFlightBytes = 2 * kMega;  // limit for one recording
constexpr std::size_t kMostCrashFrame = 8 * kMega;
constexpr const char* kUnits[] = {"merlin-devices.service", "merlin-wall.service",
                                  "merlin-page.service",    "merlin-alarms.service",
                                  "merlin-rfb.service",     "merlin.target"};

// Returns the settings without arguments of the alarms' programs, which may be secrets. If somebody
// wrote arguments into the same text as the program, only the text up to the first blank is kept.
Settings forStrangers(Settings settings) {
  for (AlarmSettings& alarm : settings.alarms) {
    for (std::size_t i = 1; i < alarm.run.size(); ++i) alarm.run[i] = kSecretLeftOut;
    if (alarm.run.empty()) continue;
    std::string& program = alarm.run.front();
    if (const auto blank = program.find_first_of(" \t\n"); blank != std::string::npos)
      program = program.substr(0, blank + 1) + kSecretLeftOut;
  }
  return settings;
}

std::string changesText(const Settings& settings) {
  std::string text;
  for (const SettingChange& c : changesFromDefaults(settings, Secrets::kLeftOut)) {
    text += fmt::format("{}: {} -> {}\n", c.pointer, c.before.empty() ? "(absent)" : c.before,
                        c.after.empty() ? "(absent)" : c.after);
  }
  return text;
}

// For an invalid configuration: adds a sentence about why its settings are missing, and adds the
// last good settings instead.
void collectKept(const ReportSubject& subject, PartFolder& folder) {
  const std::string findings = findingsText(subject.config, subject.loaded);
  folder.lacks(fmt::format("settings.json: the configuration is invalid: {}; {}",
                           findings.substr(0, findings.find('\n')),
                           subject.kept.empty() ? "no last good settings of it are kept"
                                                : "the last good settings of it are here"));
  for (const KeptSettings& kept : subject.kept) {
    const std::string name = fs::path(kept.file).filename().string();
    if (kept.loaded.parsed)
      folder.put(name + ".json",
                 settingsText(forStrangers(kept.loaded.settings), Secrets::kLeftOut));
    else
      folder.lacks(findingsText(kept.file, kept.loaded));
  }
}

void collectConfiguration(const ReportSubject& subject, PartFolder& folder) {
  const LoadedSettings& loaded = subject.loaded;
  folder.put("findings.txt", findingsText(subject.config, loaded));
  if (subject.isValid()) {
    const Settings settings = forStrangers(loaded.settings);
    folder.put("settings.json", settingsText(settings, Secrets::kLeftOut));
    folder.put("changes.txt", changesText(settings));
  } else {
    collectKept(subject, folder);
  }
  const std::string state = state::findStateFile(subject.settings().state_file, subject.instance);
  folder.put("state.json", state::StateFolder(state).read());
}

// Returns pairs of a name (the role, or "merlin" for this process) and a process id.
std::vector<std::pair<std::string, std::string>> processes(const std::string& instance) {
  std::vector<std::pair<std::string, std::string>> found = {{"merlin", "self"}};
  const auto status = askStatus(instance);
  if (!status || !status->contains("roles")) return found;
  for (const auto& [role, facts] : (*status)["roles"].items()) {
    if (const auto pid = facts.value("pid", 0); pid > 0)
      found.emplace_back(role, std::to_string(pid));
  }
  return found;
}

void collectVersions(const ReportSubject& subject, PartFolder& folder) {
  folder.put("versions.txt", versionsText(""));
  for (const auto& [name, pid] : processes(subject.instance)) {
    const std::string text = librariesText("", pid);
    if (text.empty())
      folder.lacks(fmt::format("libraries of {}: its process is another user's", name));
    else
      folder.put(fmt::format("libraries-of-{}.txt", name), text);
  }
  const auto packages =
      runInto(folder.path("packages.txt"),
              {"dpkg-query", "-W", "-f", "${Package} ${Version} ${db:Status-Status}\n", "merlin*",
               "libegl-mesa0", "libgl1-mesa-dri", "libosmesa6", "libdrm2", "libzmq5", "systemd"});
  if (!packages) folder.lacks("packages.txt: " + packages.error().what);
}

// Adds the status of all roles. If one does not answer, because it has just crashed, adds the
// status of the other, and a sentence.
void collectStatus(const ReportSubject& subject, PartFolder& folder) {
  const auto roles = findRoles(subject.instance);
  if (!roles) return folder.put("status.json", Result<std::string>(roles.error()));
  nlohmann::ordered_json both = nlohmann::ordered_json::object();
  std::string fault;
  for (const FoundRole& role : *roles) {
    const auto answer = askRole(subject.instance, role.role, {"status"});
    if (answer)
      mergeStatus(both, *answer);
    else
      fault = fmt::format("the role {}: {}", role.role, answer.error().what);
  }
  if (both.empty()) return folder.put("status.json", Result<std::string>(Error{Errc::kIo, fault}));
  addLostRoles(subject.instance, both);
  folder.put("status.json", Result<std::string>(both.dump(2) + "\n"));
  if (!fault.empty()) folder.lacks("status.json: " + fault);
}

// Runs a program and keeps its output as the file `name`, even if the program failed.
void collectOutput(const std::string& name, const std::vector<std::string>& arguments,
                   PartFolder& folder) {
  const auto status = runInto(folder.path(name), arguments);
  if (!status) return folder.lacks(fmt::format("{}: {}", name, status.error().what));
  const auto said = FileCopy::read(folder.path(name), 1000);
  const std::string first(said ? said->text().substr(0, said->text().find('\n')) : "");
  if (first.starts_with("-- No entries") || first.starts_with("No journal files"))
    folder.lacks(
        fmt::format("{}: {} (the group systemd-journal may read the journal)", name, first));
}

// Returns whether systemd is the init system; the same test as in sd_booted(3).
bool systemdRuns() {
  std::error_code error;
  return fs::is_directory("/run/systemd/system", error);
}

void collectUnits(PartFolder& folder) {
  if (!systemdRuns()) return folder.lacks("units.txt: systemd does not run this machine");
  std::vector<std::string> arguments = {"systemctl", "status", "--no-pager", "--full",
                                        "--lines=20"};
  arguments.insert(arguments.end(), std::begin(kUnits), std::end(kUnits));
  collectOutput("units.txt", arguments, folder);
}

void collectJournal(PartFolder& folder) {
  std::vector<std::string> arguments = {"journalctl", "--no-pager", "--output=short-iso-precise",
                                        "--since=-1day", "--lines=20000"};
  for (const char* unit : kUnits) arguments.push_back(std::string("--unit=") + unit);
  collectOutput("journal.txt", arguments, folder);
}

// Returns the files of the last 24 hours in the daemon's folder "flight", the newest first:
// recordings of devices (devices_role) and the last frames of walls that crashed (crash_frame).
std::vector<std::string> recordings(const ReportSubject& subject) {
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  const auto day_ago = fs::file_time_type::clock::now() - std::chrono::hours(24);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(subject.run_directory + "/flight", error)) {
    const std::string name = entry.path().filename().string();
    const bool is_kind = name.ends_with(".bytes") || name.ends_with(".png");
    if (!name.starts_with(subject.instance + "-") || !is_kind) continue;
    if (const auto time = entry.last_write_time(error); !error && time >= day_ago)
      found.emplace_back(time, entry.path().string());
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<std::string> paths;
  for (const auto& [time, path] : found) paths.push_back(path);
  return paths;
}

// Copies the existing recordings, then requests new ones and copies them too. The order matters,
// because a request may remove the oldest recordings.
void collectFlight(const ReportSubject& subject, PartFolder& folder) {
  std::set<std::string> taken;
  for (const std::string& path : recordings(subject)) {
    folder.copy(path, path.ends_with(".png") ? kMostCrashFrame : kMostFlightBytes);
    taken.insert(path);
  }
  const auto files = askRole(subject.instance, "devices", {"flight", "", seconds(10)});
  if (!files) return folder.lacks("flight recordings of now: " + files.error().what);
  for (const auto& file : nlohmann::json::parse(*files, nullptr, false)) {
    if (file.is_string() && taken.insert(file.get<std::string>()).second)
      folder.copy(file.get<std::string>(), kMostFlightBytes);
  }
}

void collectTrace(const ReportSubject& subject, PartFolder& folder) {
  const auto trace = recordTrace(subject.instance, Duration{});
  folder.put("trace.json",
             trace ? Result<std::string>(trace->json) : Result<std::string>(trace.error()));
}

void collectFrame(const ReportSubject& subject, PartFolder& folder) {
  const auto frame = render::out::captureFrame(shm::segmentName(subject.instance, "framebuffer"));
  if (!frame) return folder.lacks("frame.png: " + frame.error().what);
  const auto written =
      render::image::writePng(folder.path("frame.png"), frame->width, frame->height, frame->pixels);
  if (!written) folder.lacks("frame.png: " + written.error().what);
  for (const LostRole& lost : lostRoles(subject.instance)) {
    if (lost.role == "wall")
      folder.lacks("frame.png is the last frame of a wall that " + lost.what());
  }
}

void collectHardware(PartFolder& folder) {
  folder.put("hardware.txt", hardwareText(""));
  for (const PackedFile& id : displayIds("")) folder.put(id.name, id.content);
}

}  // namespace

std::string findingsText(const std::string& file, const LoadedSettings& loaded) {
  std::string text;
  for (Finding finding : loaded.findings) {
    if (finding.quotes) finding.what = "is not understood (left out; see merlind --check-config)";
    text += toText(file, finding) + "\n";
  }
  if (loaded.left_out > 0) text += fmt::format("{}: and {} more findings\n", file, loaded.left_out);
  return text.empty() ? file + ": no findings\n" : text;
}

std::vector<ReportPart> reportParts(const ReportSubject& s) {
  return {
      {{"configuration", true, seconds(10), 4 * kMega,
        [&s](PartFolder& f) { collectConfiguration(s, f); }},
       "the settings of " + s.config +
           " without secrets, or, where it is invalid, the last good ones "
           "that merlind keeps of it; what differs from the defaults, findings, and what people "
           "changed "
           "while the wall ran (state.json). A merlind that runs with another file has other "
           "settings"},
      {{"status", false, seconds(15), 4 * kMega, [&s](PartFolder& f) { collectStatus(s, f); }},
       "state of both roles, as by merlin status --json"},
      {{"versions", true, seconds(20), 2 * kMega, [&s](PartFolder& f) { collectVersions(s, f); }},
       "versions of MERLIN, kernel, distribution, libraries and packages; the renderer is in "
       "status.json"},
      {{"hardware", true, seconds(10), 2 * kMega, collectHardware},
       "CPU, memory, graphics cards, displays with their EDID, PCI and USB devices, serial "
       "adapters, input devices"},
      {{"units", false, seconds(10), kMega, collectUnits}, "systemctl status of MERLIN's units"},
      {{"frame", false, seconds(20), 16 * kMega, [&s](PartFolder& f) { collectFrame(s, f); }},
       "what the wall shows, as by merlin snapshot"},
      {{"trace", false, seconds(10), 8 * kMega, [&s](PartFolder& f) { collectTrace(s, f); }},
       "time of each step of the last frames, as by merlin trace; for ui.perfetto.dev"},
      {{"journal", false, seconds(30), 8 * kMega, collectJournal},
       "the journal of MERLIN's units of the last day, at most 20000 lines"},
      {{"flight", true, seconds(20), 24 * kMega, [&s](PartFolder& f) { collectFlight(s, f); }},
       "bytes of the devices' lines: recordings of the last day and of now, as by merlin flight; "
       "and the last frames of walls that crashed on that day"}};
}

}  // namespace merlin::cli
