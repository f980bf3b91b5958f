#include "render/out/output_kinds.h"

#include <algorithm>
#include <iterator>

#include "render/out/png_output.h"
#include "render/out/shared_frame.h"
#include "render/out/window/window_process.h"
#include "render/out/window_output.h"

namespace merlin::render::out {
namespace {

using OutputOrError = Result<std::unique_ptr<Output>>;

OutputOrError makeSharedMemory(const OutputSettings&, const OutputParts& parts) {
  auto made = SharedFrameOutput::make(parts.frame_name, parts.plan, parts.generation, parts.clock);
  if (!made) return made.error();
  return std::unique_ptr<Output>(*std::move(made));
}

OutputOrError makePng(const OutputSettings& settings, const OutputParts& parts) {
  return std::unique_ptr<Output>(
      std::make_unique<PngOutput>(settings.path, settings.interval_s, parts.watch));
}

OutputOrError makeWindow(const OutputSettings& settings, const OutputParts& parts) {
  auto program = windowProgram();
  if (!program) return program.error();
  WindowActs acts = parts.window;
  if (parts.panel) acts.panel = panelIn(settings, parts.plan, *parts.panel);
  return std::unique_ptr<Output>(std::make_unique<WindowOutput>(
      settings.window, acts, *std::move(program), parts.watch, parts.clock));
}

OutputOrError makeKms(const OutputSettings& settings, const OutputParts& parts) {
  const PictureSize size = *pictureSize(settings, parts.tiles);
  return parts.cards.makeOutput(settings.kms, size.width, size.height);
}

// In the order of OutputKind.
constexpr OutputOrError (*kMakers[])(const OutputSettings&, const OutputParts&) = {
    makeSharedMemory, makePng, makeWindow, makeKms};
static_assert(std::size(kMakers) == std::size(kOutputKindNames));

}  // namespace

std::optional<PanelPointer::Place> panelIn(const OutputSettings& settings,
                                           const tiles::TilePlan& plan,
                                           const PanelPointer::Place& in_frame) {
  if (settings.tiles.empty()) return in_frame;
  for (const PlacedTile& placed : settings.tiles) {
    const auto tile = std::ranges::find(plan.tiles, placed.tile, &tiles::Tile::name);
    if (tile == plan.tiles.end() || placed.mirror != Mirror::kNone || placed.turn != Turn::k0)
      continue;
    const int x = in_frame.x - tile->x, y = in_frame.y - tile->y;
    if (x < 0 || y < 0 || x >= tile->width || y >= tile->height) continue;
    return PanelPointer::Place{placed.x + x,    placed.y + y,       in_frame.width,
                               in_frame.height, tile->x - placed.x, tile->y - placed.y};
  }
  return std::nullopt;
}

Result<Ok> checkIsThere(OutputKind kind) {
  if (kind != OutputKind::kWindow) return Ok{};
  const auto program = windowProgram();
  if (!program) return program.error();
  return Ok{};
}

OutputOrError makeOutput(const OutputSettings& settings, const OutputParts& parts) {
  return kMakers[static_cast<std::size_t>(settings.kind)](settings, parts);
}

}  // namespace merlin::render::out
