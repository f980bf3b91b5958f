// ./dev bench fuzz-meshes [N]: runs hostile meshes through the repairs after reading, the reduction
// with both costs, and the dendrogram. For each kind of fault it prints the first seed, with which
// the fault can be reproduced.
#include <csignal>
#include <cstring>
#include <map>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/cli/progress.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/mesh_fuzz.h"

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

// Faults of one kind.
struct Faults {
  std::uint64_t count = 0, first_seed = 0;
  std::string first;
};

bool fuzz(std::uint64_t seed, std::uint64_t count, Report& report) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL}) ::signal(signal, sayWhere);
  const SystemClock clock;
  const Timestamp began = clock.now();
  cli::ProgressBar bar("fuzzing", "meshes", clock);
  MeshFuzz fuzz;
  std::map<std::string, Faults> faults;
  for (std::uint64_t i = 0; i < count; ++i) {
    current_seed = seed + i;
    if (!fuzz.run(seed + i)) {
      Faults& kind = faults[kindOf(fuzz.fault)];
      if (kind.count++ == 0) {
        kind.first_seed = seed + i;
        kind.first = fuzz.fault;
      }
    }
    if (i % 1024 == 0) bar.update(static_cast<double>(i) / static_cast<double>(count), i);
  }
  bar.finish(count);
  const double seconds = toSeconds(clock.now() - began);
  std::uint64_t reduced = 0;
  for (const auto& [name, n] : fuzz.counts) {
    if (name.starts_with("reduced by ")) reduced += n;
    report.text("{:>12}  {}\n", n, name);
  }
  // If all meshes are refused as invalid, no reduction was tested.
  if (reduced == 0 && faults.empty()) {
    throw DidNotRun(fmt::format(
        "none of {} meshes reached the reduction; --count sets a higher number", count));
  }
  const double rate = static_cast<double>(count) / seconds;
  report.text("{:>12.0f}  meshes a second\n", rate);
  for (const auto& [kind, f] : faults)
    report.text("{:>12}  FAULT: {}; again: --count 1 --seed {}\n", f.count, f.first, f.first_seed);
  report.text("seeds {} to {}: {}\n", seed, seed + count - 1,
              faults.empty() ? "no fault" : "with faults");
  const auto total = [&](std::uint64_t n) { return Measured::of(double(n), count, "meshes"); };
  report.figure("rate", Measured::of(rate, count, "meshes"), "1/s");
  report.figure("reduced", total(reduced), "1");
  report.figure("kinds_of_faults", total(faults.size()), "1");
  return faults.empty();
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app("Gives hostile meshes to every step of mesh processing.");
  std::uint64_t seed = 1, count = 10'000'000;
  app.option("--seed", seed, "Seed of the first mesh; each further one has the next seed")
      .showDefault();
  app.option("--count", count, "Number of meshes").range(1, 1'000'000'000).showDefault();
  return app.run("fuzz-meshes", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::fuzz(seed, count, report);
  });
}
