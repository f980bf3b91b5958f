#include "daemon/cli/mesh/reduction_step.h"

#include "daemon/base/clock.h"
#include "daemon/cli/mesh/mesh_memory.h"
#include "render/lod/io/mrm_file.h"

namespace merlin::cli {

Result<render::reduce::Reduction> reduceWithProgress(const render::mesh::Mesh& mesh,
                                                     const render::reduce::ReduceSettings& settings,
                                                     double& seconds,
                                                     const ProgressListener& listener) {
  const SystemClock clock;
  const std::string title = "reducing";
  ProgressBar bar(title, "collapses", clock);
  const Timestamp began = clock.now();
  const auto all = static_cast<double>(mesh.triangleCount());
  auto reduction =
      render::reduce::reduce(mesh, settings, [&](const render::reduce::ReduceProgress& p) {
        const double share = 1 - static_cast<double>(p.triangles) / all;
        bar.update(share, p.collapses);
        if (listener) listener(title, share);
        return true;
      });
  if (!reduction) return reduction;
  seconds = toSeconds(clock.now() - began);
  bar.finish(reduction->report.collapses);
  return reduction;
}

Result<std::size_t> writeReduced(const ModelOutput& output, const render::mesh::Mesh& mesh,
                                 double& seconds) {
  const auto named = [&](const Error& error) {
    return Error{error.code, output.named + ": " + error.what};
  };
  if (const auto good = render::lod::checkNames(mesh); !good) return named(good.error());
  render::reduce::ReduceSettings settings;
  settings.threads = output.threads;
  settings.weights = render::reduce::findCost(settings.cost)->weights(mesh);
  const auto room = roomForReduction(sizeOf(mesh), 0, settings, output.memory);
  if (!room) return named(room.error());
  settings.memory = *room;
  auto reduction = reduceWithProgress(mesh, settings, seconds, output.progress);
  if (!reduction) return reduction.error();
  reduction->log.about += output.about;
  const auto done = render::lod::writeMrm(output.file, mesh, reduction->log, output.threads);
  if (!done) return done.error();
  return reduction->report.triangles;
}

void addLimits(Command command, std::uint64_t& memory, unsigned& threads) {
  command
      .option("--memory", memory,
              "Maximum memory of the whole command, such as 900M or 16G; the default is the free "
              "memory")
      .size()
      .typeName("SIZE");
  command
      .option("--threads", threads,
              "Maximum number of threads; 0: all cores. The result does not depend on this number")
      .showDefault();
}

}  // namespace merlin::cli
