#include "daemon/wall/aligned_output.h"

#include <memory>
#include <utility>

#include "render/correct/io/mpcdi.h"
#include "render/correct/output_correction.h"

namespace merlin::wall {

Result<AlignedOutput> alignedOutput(const render::out::OutputSettings& output,
                                    const render::out::PictureSize& size,
                                    render::correct::SignalParts parts, ThreadTeam& team,
                                    render::correct::CorrectionPass& pass) {
  const render::correct::CorrectionSettings& settings = output.correction;
  std::shared_ptr<render::correct::MeasuredCorrection> measured;  // used by `make` and its copies
  if (!settings.mpcdi.empty()) {
    auto read = render::correct::readMeasured(settings.mpcdi, settings.mpcdi_region);
    if (!read) return read.error();
    measured = std::make_shared<render::correct::MeasuredCorrection>(*std::move(read));
  }
  const auto make = [size, parts, measured, &team,
                     &pass](const render::correct::CorrectionSettings& wanted) {
    auto map = render::correct::makeCorrectionMap(wanted, size.width, size.height, measured.get(),
                                                  Threads(threadsOr(0)), parts);
    return std::unique_ptr<render::frame::Correction>(
        std::make_unique<render::correct::OutputCorrection>(std::move(map),
                                                            Threads(threadsOr(0), team), &pass));
  };
  return AlignedOutput{output.shownName(), size.width, size.height, settings, make};
}

}  // namespace merlin::wall
