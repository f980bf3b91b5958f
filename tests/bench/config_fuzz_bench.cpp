// ./dev bench fuzz-config [N]: gives mutated configurations to the loader. For each kind of fault
// it prints the first seed, with which the fault can be reproduced.
#include <array>
#include <csignal>
#include <cstring>
#include <map>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "config/writer.h"
#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/progress.h"
#include "tests/bench/command_line.h"
#include "tests/bench/config_fuzz.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

volatile std::uint64_t current_seed = 0;

// Prints the seed at a crash, since a crash is a fault too. A signal handler may call few
// functions.
void sayWhere(int signal) {
  char text[96] = "\nfault: a crash; again: --count 1 --seed ";
  char* end = text + std::strlen(text);
  char digits[24];
  int n = 0;
  std::uint64_t seed = current_seed;
  do digits[n++] = static_cast<char>('0' + seed % 10);
  while ((seed /= 10) > 0);
  while (n > 0) *end++ = digits[--n];
  *end++ = '\n';
  [[maybe_unused]] const auto written =
      ::write(STDERR_FILENO, text, static_cast<std::size_t>(end - text));
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

std::vector<std::string> examples(const std::string& folder) {
  std::vector<std::string> all = {settingsText(Settings{})};
  for (const char* name : {"demo", "demo-window", "installed", "wall", "wall-kms-four",
                           "wall-stereo", "wall-three-160"}) {
    const std::string path = fmt::format("{}/{}.json", folder.empty() ? "config" : folder, name);
    const auto file = FileCopy::read(path);
    if (!file) didNotRun("the examples", file.error().what, "run it in the source tree");
    all.emplace_back(file->text());
  }
  return all;
}

struct Options {
  std::uint64_t seed = 1, count = 100'000;
  std::string configurations;  // folder; empty: the folder of the source tree
};

struct Faults {
  std::uint64_t count = 0, first_seed = 0;
};

bool fuzz(const Options& options, Report& report) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL}) ::signal(signal, sayWhere);
  constexpr std::array kNames = {"no JSON, or too deep or long", "invalid",
                                 "valid, numbers adjusted", "valid"};
  const SystemClock clock;
  cli::ProgressBar bar("fuzzing", "configurations", clock);
  const ConfigFuzz fuzz(examples(options.configurations));
  std::array<std::uint64_t, kNames.size()> outcomes{};
  std::map<std::string, Faults> faults;
  for (std::uint64_t i = 0; i < options.count; ++i) {
    current_seed = options.seed + i;
    const auto result = fuzz.run(current_seed);
    ++outcomes[static_cast<std::size_t>(result.outcome)];
    if (!result.fault.empty()) {
      Faults& kind = faults[result.fault];
      if (kind.count++ == 0) kind.first_seed = current_seed;
      if (options.count == 1) report.text("{}\n", result.text);
    }
    if (i % 256 == 0) bar.update(double(i) / double(options.count), i);
  }
  bar.finish(options.count);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    report.text("{:>10}  {}\n", outcomes[i], kNames[i]);
    constexpr std::array kFigures = {"no_json", "invalid", "adjusted", "valid"};
    report.figure(kFigures[i], shareOf(outcomes[i], options.count, "configurations"), "1");
  }
  // If the loader refused all configurations, the check of accepted ones did not run.
  if (options.count >= 1000 && outcomes[3] == 0)
    didNotRun("the loader", "it accepted none of the configurations",
              "see tests/bench/config_fuzz.h");
  for (const auto& [what, f] : faults) {
    report.text("{:>10}  FAULT: the loader {}; again: --count 1 --seed {}\n", f.count, what,
                f.first_seed);
  }
  report.text("seeds {} to {}: {}\n", options.seed, options.seed + options.count - 1,
              faults.empty() ? "no crash, and no key was ignored" : "with faults");
  report.figure("kinds_of_faults",
                Measured::of(double(faults.size()), options.count, "configurations"), "1");
  return faults.empty();
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app("Gives mutated configurations to the loader.");
  app.option("--seed", options.seed,
             "Seed of the first configuration; each further one has the next seed")
      .showDefault();
  app.option("--count", options.count, "Number of configurations")
      .range(std::size_t{1}, std::size_t{1'000'000'000})
      .showDefault();
  app.option("--configurations", options.configurations,
             "Folder of the example configurations; the default is config");
  return app.run("fuzz-config", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::fuzz(options, report);
  });
}
