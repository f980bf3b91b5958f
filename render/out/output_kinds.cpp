#include "render/out/output_kinds.h"

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
  return std::unique_ptr<Output>(std::make_unique<WindowOutput>(
      settings.window, parts.window, *std::move(program), parts.watch, parts.clock));
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
