#include "daemon/cli/foreign_import.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/import_child.h"
#include "daemon/cli/progress.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/cli/work_folder.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

// While this object exists, SIGTERM, SIGINT and SIGHUP make stop() readable, by which the import
// ends, instead of ending this process.
class HeldSignals {
 public:
  HeldSignals() {
    ::sigprocmask(SIG_SETMASK, nullptr, &before_);
    stop_ = stopSignals();
  }
  ~HeldSignals() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  int stop() const noexcept { return stop_.get(); }
  // Consumes the signal that has ended the import.
  void take() const {
    signalfd_siginfo info{};
    [[maybe_unused]] const auto n = ::read(stop_.get(), &info, sizeof info);
  }

 private:
  sigset_t before_{};
  UniqueFd stop_;
};

Error named(const ForeignFile& file, const Error& error) {
  if (error.what.starts_with(file.input + ":") || error.code == Errc::kClosed) return error;
  return {error.code, file.input + ": " + error.what};
}

std::vector<std::string> argumentsFor(const ForeignFile& file, const std::string& folder,
                                      std::uint64_t bytes) {
  std::vector<std::string> arguments = {file.kind,
                                        file.input,
                                        folder,
                                        "--memory",
                                        std::to_string(file.memory_bytes),
                                        "--cpu",
                                        std::to_string(60 + bytes / file.bytes_per_second)};
  arguments.insert(arguments.end(), file.options.begin(), file.options.end());
  return arguments;
}

// Waits for the end of the import, with a progress bar from the third second on. Returns the file
// name of the result.
Result<std::string> follow(ImportChild& child, int stop, Duration patience) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  ProgressBar bar("reading", "items", clock);
  bool shown = false;
  auto name = child.follow(
      stop,
      [&](const ImportReport& report) {
        shown = shown || clock.now() - began > std::chrono::seconds(2);
        if (shown) bar.update(report.share(), report.items());
      },
      patience);
  if (shown && name) bar.finish(child.report().items());
  return name;
}

// Checks that the folder contains regular files only, because merlin-import could have made a link
// to a file that it may not read itself.
Result<Ok> checkFolder(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.symlink_status(error).type() != fs::file_type::regular)
      return Error{Errc::kMalformed, "merlin-import left something that is not a file"};
  }
  return Ok{};
}

Result<ForeignReport> importInto(const ForeignFile& file, const std::string& folder, int stop,
                                 const std::function<Result<Ok>(const std::string&)>& take) {
  const auto stamp = fileStamp(file.input);
  if (!stamp) return Error{Errc::kNotFound, file.input + ": is not a file"};
  auto child = ImportChild::start(argumentsFor(file, folder, stamp->size));
  if (!child) return child.error();
  const auto name = follow(*child, stop, patienceFor(stamp->size, file.bytes_per_second));
  if (!name) return named(file, name.error());
  const ImportReport& said = child->report();
  ForeignReport report{nlohmann::json::parse(said.facts(), nullptr, false), said.notes()};
  for (const std::string& what : said.lacks())
    report.notes.push_back(fmt::format("this system lacks {}; merlin-import ran without it", what));
  if (!report.facts.is_object()) report.facts = nlohmann::json::object();
  if (const auto regular = checkFolder(folder); !regular) return named(file, regular.error());
  if (const auto taken = take(folder + "/" + *name); !taken) return named(file, taken.error());
  return report;
}

}  // namespace

std::optional<std::size_t> ForeignReport::count(const char* key) const {
  const auto found = facts.find(key);
  if (found == facts.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::size_t>();
}

double ForeignReport::number(const char* key) const {
  const auto found = facts.find(key);
  return found != facts.end() && found->is_number() ? found->get<double>() : 0;
}

std::string ForeignReport::text(const char* key) const {
  const auto found = facts.find(key);
  return found != facts.end() && found->is_string() ? oneLine(found->get<std::string>()) : "";
}

Duration patienceFor(std::uint64_t bytes, std::uint64_t bytes_per_second) noexcept {
  // Size to which `bytes` is limited, against an overflow.
  constexpr std::uint64_t kMost = std::uint64_t{1} << 44;
  return ImportChild::kPatience +
         std::chrono::seconds(static_cast<long>(std::min(bytes, kMost) / (10 * bytes_per_second)));
}

Result<ForeignReport> importForeign(const ForeignFile& file,
                                    const std::function<Result<Ok>(const std::string&)>& take) {
  // Held before the folder is made, because a signal would otherwise leave the folder behind.
  const HeldSignals signals;
  const auto folder = WorkFolder::make(file.output);
  if (!folder) return folder.error();
  auto report = importInto(file, folder->path(), signals.stop(), take);
  if (!report && report.error().code == Errc::kClosed) signals.take();
  return report;
}

}  // namespace merlin::cli
