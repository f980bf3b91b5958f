#include "render/out/output_kinds.h"

#include <iterator>

#include "render/out/png_output.h"
#include "render/out/shared_frame.h"

namespace merlin::render {
namespace {

using Made = Result<std::unique_ptr<Output>>;

Made makeSharedMemory(const OutputSettings&, const OutputParts& parts) {
  auto made = SharedFrameOutput::make(parts.frame_name, parts.plan, parts.generation, parts.clock);
  if (!made) return made.error();
  return std::unique_ptr<Output>(*std::move(made));
}

Made makePng(const OutputSettings& settings, const OutputParts& parts) {
  return std::unique_ptr<Output>(
      std::make_unique<PngOutput>(settings.path, settings.interval_s, parts.watch));
}

// In the order of OutputKind.
constexpr Made (*kMakers[])(const OutputSettings&, const OutputParts&) = {makeSharedMemory,
                                                                          makePng};
static_assert(std::size(kMakers) == std::size(kOutputKindNames));

}  // namespace

Made makeOutput(const OutputSettings& settings, const OutputParts& parts) {
  return kMakers[static_cast<std::size_t>(settings.kind)](settings, parts);
}

}  // namespace merlin::render
