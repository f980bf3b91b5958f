#include "daemon/cli/mesh/reduction_step.h"

#include "daemon/base/clock.h"
#include "daemon/cli/progress.h"

namespace merlin::cli {

Result<render::reduce::Reduction> reduceWithProgress(const render::mesh::Mesh& mesh,
                                                     const render::reduce::ReduceSettings& settings,
                                                     double& seconds) {
  const SystemClock clock;
  ProgressBar bar("reducing", "collapses", clock);
  const Timestamp began = clock.now();
  const auto all = static_cast<double>(mesh.triangleCount());
  auto reduction =
      render::reduce::reduce(mesh, settings, [&](const render::reduce::ReduceProgress& p) {
        bar.update(1 - static_cast<double>(p.triangles) / all, p.collapses);
        return true;
      });
  if (!reduction) return reduction;
  seconds = toSeconds(clock.now() - began);
  bar.finish(reduction->report.collapses);
  return reduction;
}

}  // namespace merlin::cli
