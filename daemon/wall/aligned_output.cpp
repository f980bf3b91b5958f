#include "daemon/wall/aligned_output.h"

#include <memory>
#include <utility>

#include "render/correct/io/mpcdi.h"
#include "render/correct/output_correction.h"
#include "render/frame/tile_arrangement.h"

namespace merlin::wall {

namespace {

// Returns the axes of the first tile. All tiles of an output are mounted in the same way.
state::SeenAxes seenAxes(const std::vector<render::out::PlacedTile>& tiles) {
  if (tiles.empty()) return {};
  const render::frame::TileAxes axes = render::frame::axesOf(tiles.front());
  const auto step = [](const render::frame::TileAxes::Step& s) {
    return state::Offset{static_cast<double>(s.x), static_cast<double>(s.y)};
  };
  return {step(axes.column), step(axes.row)};
}

}  // namespace

AlignedOutput alignedOutput(const render::out::OutputSettings& output,
                            const render::out::PictureSize& size,
                            render::correct::SignalParts parts, ThreadTeam& team,
                            render::correct::CorrectionPass& pass, std::string& unreadable) {
  render::correct::CorrectionSettings settings = output.correction;
  std::shared_ptr<render::correct::MeasuredCorrection> measured;  // shared by all copies of `make`
  if (!settings.mpcdi.empty()) {
    if (auto read = render::correct::readMeasured(settings.mpcdi, settings.mpcdi_region)) {
      measured = std::make_shared<render::correct::MeasuredCorrection>(*std::move(read));
    } else {
      unreadable = read.error().what;
      settings.mpcdi.clear();
      settings.mpcdi_region.clear();
    }
  }
  const auto make = [size, parts, measured, &team,
                     &pass](const render::correct::CorrectionSettings& wanted) {
    auto map = render::correct::makeCorrectionMap(wanted, size.width, size.height, measured.get(),
                                                  Threads(threadsOr(0)), parts);
    return std::unique_ptr<render::frame::Correction>(
        std::make_unique<render::correct::OutputCorrection>(std::move(map),
                                                            Threads(threadsOr(0), team), &pass));
  };
  AlignedOutput made{output.shownName(), size.width, size.height, settings, make};
  made.axes = seenAxes(output.tiles);
  return made;
}

}  // namespace merlin::wall
