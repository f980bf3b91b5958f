#include "daemon/cli/mesh/compare_options.h"

namespace merlin::cli {

void addCompareOptions(Command command, render::compare::CompareSettings& settings) {
  command
      .option("--samples", settings.samples,
              "Number of points sampled on each surface, for all results except the maximum")
      .range(std::size_t{1}, std::size_t{1'000'000'000})
      .showDefault();
  command.option("--seed", settings.seed, "Seed of the sampling").showDefault();
  command
      .option("--width", settings.width_percent,
              "Width of the interval that contains the maximum, in percent of the diagonal of the "
              "original's bounding box")
      .positive()
      .showDefault();
  command.option("--threads", settings.threads,
                 "Number of threads; 0: all cores. The results do not depend on this number");
}

}  // namespace merlin::cli
