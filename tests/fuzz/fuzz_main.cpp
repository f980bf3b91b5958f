// merlin_fuzz: libFuzzer's program for the targets of targets.h. The environment variable
// MERLIN_FUZZ names the target; ./dev fuzz starts the program once for each target.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/targets.h"

namespace {

const merlin::fuzz::Target& chosen() {
  const char* const name = std::getenv("MERLIN_FUZZ");  // NOLINT(concurrency-mt-unsafe)
  const auto all = merlin::fuzz::targets();
  const auto at = std::find_if(all.begin(), all.end(), [&](const merlin::fuzz::Target& target) {
    return name && std::string_view(name) == target.name;
  });
  if (at != all.end()) return *at;
  std::fprintf(stderr, "merlin_fuzz: MERLIN_FUZZ names one of these:");
  for (const merlin::fuzz::Target& target : all) std::fprintf(stderr, " %s", target.name);
  std::fprintf(stderr, "\n");
  std::exit(2);  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace

// The functions that libFuzzer calls by name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const merlin::fuzz::Target& target = chosen();
  target.run({bytes, size});
  return 0;
}
