#include "render/correct/output_correction.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace merlin::render::correct {
namespace {

constexpr int kRows = 16;  // per block: more blocks than threads, each tens of microseconds

}  // namespace

OutputCorrection::OutputCorrection(CorrectionMap map, Threads threads, CorrectionPass* pass)
    : map_(std::make_shared<const CorrectionMap>(std::move(map))),
      threads_(threads),
      pass_(pass),
      pixels_(std::size_t{4} * static_cast<std::size_t>(map_->width) *
              static_cast<std::size_t>(map_->height)) {}

out::Signal OutputCorrection::apply(const out::Signal& picture) {
  const CorrectionMap& map = *map_;
  assert(picture.width == map.source_width && picture.height == map.source_height);
  if (pass_ && pass_->run(map_, picture.pixels, pixels_)) return {map.width, map.height, pixels_};
  forBlocks(threads_, static_cast<std::size_t>((map.height + kRows - 1) / kRows),
            [&](std::size_t block) {
              const int first = static_cast<int>(block) * kRows;
              correct_(map, picture.pixels.data(), pixels_.data(), first,
                       std::min(first + kRows, map.height));
            });
  return {map.width, map.height, pixels_};
}

out::Signal OutputCorrection::draw(const out::Signal& picture,
                                   std::span<const out::DrawPlace> places) {
  const CorrectionMap& map = *map_;
  assert(picture.width == map.source_width && picture.height == map.source_height);
  // PictureChecks compares these rows with what the output shows, so they are needed in memory.
  const auto rows = out::digestRows(map.height);
  if (pass_ && pass_->draw(map_, picture.pixels, places, rows, pixels_))
    return {map.width, map.height, pixels_, true};
  return apply(picture);
}

}  // namespace merlin::render::correct
