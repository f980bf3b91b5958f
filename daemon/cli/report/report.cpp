// merlin report: collects in one archive the information that is needed to find the cause of a
// fault.
#include <chrono>
#include <filesystem>
#include <memory>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "config/loader.h"
#include "config/usual_file.h"
#include "daemon/base/files.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/report/contents.h"
#include "daemon/cli/report/report_parts.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/state/state_folder.h"

namespace merlin::cli {
namespace {

constexpr const char* kEnding = ".tar.gz";

struct ReportOptions {
  std::string config = kUsualConfig, instance, output;
  bool json = false;
};

// Returns the folder of the daemon's sockets: that of the running daemon or, if it does not run,
// the configured or the usual one.
std::string runDirectoryOf(const std::string& instance, const Settings& settings) {
  constexpr std::string_view kIpc = "ipc://";
  if (const auto roles = findRoles(instance)) {
    const std::string& endpoint = roles->front().endpoints.status;
    if (endpoint.starts_with(kIpc))
      return std::filesystem::path(endpoint.substr(kIpc.size())).parent_path().string();
  }
  return settings.run_directory.empty() ? "/run/merlin" : settings.run_directory;
}

ReportSubject subjectOf(const ReportOptions& options) {
  ReportSubject subject{options.config, loadSettingsFile(options.config), options.instance, {}};
  if (!subject.isValid()) {
    for (const std::string& file : state::findLastGoodFiles(options.config))
      subject.kept.push_back({file, loadSettingsFile(file)});
  }
  if (subject.instance.empty()) subject.instance = subject.settings().instance;
  subject.run_directory = runDirectoryOf(subject.instance, subject.settings());
  return subject;
}

// Returns the files with the token of the web page and the password of merlin-rfb, the latter at
// the place that merlin-rfb's unit suggests.
std::vector<std::string> otherSecretFiles(const ReportSubject& subject) {
  const auto folder = std::filesystem::path(subject.config).parent_path();
  return {fmt::format("{}/{}-page.token", subject.run_directory, subject.instance),
          (folder / "rfb.password").string()};
}

void printPart(const CollectedPart& part) {
  std::size_t bytes = 0;
  for (const PackedFile& file : part.result.files) bytes += file.content.size();
  printOut("{}: {} file{}, {:.1f} kB\n", part.name, part.result.files.size(),
           part.result.files.size() == 1 ? "" : "s", static_cast<double>(bytes) / 1000);
  for (const std::string& what : part.result.missing) printOut("  missing: {}\n", what);
  std::fflush(stdout);
}

Result<std::vector<CollectedPart>> collect(const ReportSubject& subject,
                                           const KnownSecrets& secrets, bool print) {
  sigset_t mask{};
  ::sigprocmask(SIG_SETMASK, nullptr, &mask);
  const UniqueFd stop = stopSignals();
  std::vector<CollectedPart> parts;
  for (const ReportPart& part : reportParts(subject)) {
    auto result = runPart(part.settings, stop.get(), mask);
    if (!result) return result.error();
    parts.push_back({part.settings.name, part.about, *std::move(result)});
    makeFit(parts, secrets);  // removes secrets, and limits the size of all parts together
    if (print) printPart(parts.back());
  }
  return parts;
}

int report(const ReportOptions& options) {
  if (const auto named = checkEnding(options.output, "report", kEnding); !named)
    return fail(named.error());
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  const ReportSubject subject = subjectOf(options);
  KnownSecrets secrets(subject.loaded.settings, otherSecretFiles(subject));
  for (const KeptSettings& kept : subject.kept) secrets.add(kept.loaded.settings);
  const auto parts = collect(subject, secrets, !options.json);
  if (!parts) return fail(parts.error());
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const std::string file = std::filesystem::path(options.output).filename().string();
  const std::string folder = file.substr(0, file.size() - std::string_view(kEnding).size());
  const std::string readme = secrets.without(
      readmeText(*parts, fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(now))));
  const auto written = writeTarGz(
      options.output, packedFiles(*parts, folder.empty() ? "report" : folder, readme), now);
  if (!written) return fail(written.error());
  const auto stamp = fileStamp(options.output);
  const std::size_t bytes = stamp ? stamp->size : 0;
  if (options.json) {
    fmt::print("{}\n", partsJson(*parts, options.output, bytes));
  } else {
    printOut("{}: {:.1f} kB; README.txt in it says what it has and what was left out\n",
             options.output, static_cast<double>(bytes) / 1000);
  }
  return kExitDone;
}

}  // namespace

void addReport(Command app, Run& run) {
  const auto options = std::make_shared<ReportOptions>();
  Command command = app.subcommand(
      "report",
      "Collect in one file what somebody needs to help you with a fault: configuration without "
      "secrets, versions, status, journal, flight recordings, trace, frame and hardware. If "
      "merlind does not run, the file has only the parts that can be collected without "
      "it.\nExample: merlin report -o wall.tar.gz");
  command.option("-o", options->output, "The report").required().typeName("FILE.tar.gz");
  command.option("-c,--config", options->config, "The daemon's configuration")
      .typeName("FILE")
      .showDefault();
  command
      .option("--instance", options->instance,
              "Name of the daemon; by default the setting instance of the configuration")
      .typeName("NAME");
  command.flag("--json", options->json, "Print the list of parts as JSON, for programs");
  command.callback([options, &run] { run = [options] { return report(*options); }; });
}

}  // namespace merlin::cli
