// merlin-import: reads one file of another program's format, in a sandbox, and writes what MERLIN
// shows. Started by `merlin image import` and `merlin mesh import`, which read its output.
//
// It writes to stdout, a line each: "lacks WHAT", "pixels N", "progress SHARE ITEMS", "note WHAT",
// then "done FILE {JSON}" or "failed CODE WHY".
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/exit_status.h"
#include "daemon/import/importers.h"
#include "daemon/import/sandbox.h"
#include "render/import/model_file.h"

namespace merlin::import {
namespace {

constexpr Duration kReportEvery = std::chrono::milliseconds(100);

int usage() {
  printError(
      "usage: merlin-import KIND IN FOLDER [--panorama] [--quality Q] [--tile PX] "
      "[--range LOW:HIGH] "
      "[--format ENDING] [--hdu N|NAME] [--variable NAME|N] [--depth N] [--neighbours K] [--trim "
      "LENGTH] [--memory BYTES] [--cpu SECONDS]\n");
  for (const Importer& importer : importers())
    printError("  {}: {}\n", importer.kind, importer.help);
  printError("People use: merlin image import IN -o OUT, or merlin mesh import IN -o OUT\n");
  return kExitBadInput;
}

void tell(const std::string& line) {
  fmt::print("{}\n", oneLine(line));
  std::fflush(stdout);
}

int failed(const Error& error) {
  tell(fmt::format("failed {} {}", static_cast<int>(error.code), error.what));
  return exitStatus(error);
}

struct Options {
  Request request;
  Limits limits;
};

template <typename T>
bool parse(std::string_view text, T& value) {
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && rest == text.data() + text.size();
}

// Parses the ending of a file's name, without the dot: 1 to 8 lower-case letters and digits,
// because it becomes part of names that a library sees.
bool parse(std::string_view text, std::string& ending) {
  const bool plain = std::ranges::all_of(
      text, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
  ending = text;
  return plain && !text.empty() && text.size() <= 8;
}

// Parses "LOW:HIGH"; both must be finite, and LOW less than HIGH.
bool parse(std::string_view text, std::optional<std::array<double, 2>>& range) {
  const std::size_t colon = text.find(':');
  std::array<double, 2> ends{};
  if (colon == std::string_view::npos || !parse(text.substr(0, colon), ends[0]) ||
      !parse(text.substr(colon + 1), ends[1]) || !(ends[1] - ends[0] > 0) ||
      !std::isfinite(ends[1] - ends[0]))
    return false;
  range = ends;
  return true;
}

// Accepts any name, because it is only compared.
bool parseName(std::string_view text, std::string& name) {
  name = text;
  return true;
}

std::optional<Options> parseOptions(int argc, char** argv) {
  Options o;
  o.request.input = argv[2];
  o.request.folder = argv[3];
  for (int i = 4; i < argc; ++i) {
    const std::string_view name = argv[i];
    if (name == "--panorama") {
      o.request.panorama = true;
      continue;
    }
    if (++i == argc) return std::nullopt;
    const std::string_view value = argv[i];
    const bool good = (name == "--quality" && parse(value, o.request.quality)) ||
                      (name == "--tile" && parse(value, o.request.tile_px)) ||
                      (name == "--range" && parse(value, o.request.range)) ||
                      (name == "--format" && parse(value, o.request.format)) ||
                      (name == "--hdu" && parseName(value, o.request.hdu)) ||
                      (name == "--variable" && parseName(value, o.request.variable)) ||
                      (name == "--depth" && parse(value, o.request.surface.depth)) ||
                      (name == "--neighbours" && parse(value, o.request.surface.neighbours)) ||
                      (name == "--trim" && parse(value, o.request.surface.trim)) ||
                      (name == "--memory" && parse(value, o.limits.memory_bytes)) ||
                      (name == "--cpu" && parse(value, o.limits.cpu_s));
    if (!good) return std::nullopt;
  }
  return o;
}

// Limits the size of the result to 1.5 times its raw data and 64 MiB. The coarser levels of a
// pyramid make it a third larger than its raw data.
Result<Ok> limitResult(std::uint64_t raw_bytes) {
  return limitFileSize(raw_bytes / 2 * 3 + (std::uint64_t{64} << 20));
}

// Errors: those of the importer, and kInvalidArgument (it takes more memory than is allowed).
Result<Imported> runWithinMemory(const Importer& importer, const Request& request,
                                 const Reports& reports) {
  try {
    return importer.run(request, reports);
  } catch (const std::bad_alloc&) {
    return render::import::needsMoreMemory(request.input);
  }
}

int run(const Importer& importer, const char* program, Options options) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends with the program that started this one
  ::setenv("TMPDIR", options.request.folder.c_str(), 1);
  if (const auto prepared = importer.prepare(program); !prepared) return failed(prepared.error());
  std::vector<std::string> inputs = {options.request.input};
  if (importer.beside) {
    options.request.beside = importer.beside(options.request.input);
    inputs.insert(inputs.end(), options.request.beside.begin(), options.request.beside.end());
  }
  const auto closed = closeSandbox(inputs, options.request.folder, options.limits);
  if (!closed) return failed(closed.error());
  for (const std::string& what : *closed) tell("lacks " + what);
  const SystemClock clock;
  Timestamp told{};
  const Reports reports{[](std::uint64_t raw_bytes) {
                          tell(fmt::format("pixels {}", raw_bytes / 3));
                          return limitResult(raw_bytes);
                        },
                        [&](double share, std::int64_t items) {
                          if (clock.now() - told < kReportEvery) return;
                          told = clock.now();
                          tell(fmt::format("progress {:.6f} {}", share, items));
                        },
                        [](const std::string& what) { tell("note " + what); }};
  const auto imported = runWithinMemory(importer, options.request, reports);
  if (!imported) return failed(imported.error());
  tell(fmt::format("done {} {{{}}}", imported->file, imported->facts));
  return kExitDone;
}

int main(int argc, char** argv) {
  if (argc < 4) return usage();
  const auto all = importers();
  const auto importer = std::ranges::find(all, std::string_view(argv[1]), &Importer::kind);
  if (importer == all.end()) return usage();
  const auto options = parseOptions(argc, argv);
  return options ? run(*importer, argv[0], *options) : usage();
}

}  // namespace
}  // namespace merlin::import

int main(int argc, char** argv) {
  merlin::openStandardStreams();
  return merlin::runGuarded("merlin-import", [&] { return merlin::import::main(argc, argv); });
}
