#include "render/correct/output_correction.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace merlin::render::correct {
namespace {

constexpr int kRows = 16;  // per block: more blocks than threads, each tens of microseconds

}  // namespace

OutputCorrection::OutputCorrection(CorrectionMap map, Threads threads)
    : map_(std::move(map)),
      threads_(threads),
      pixels_(std::size_t{4} * static_cast<std::size_t>(map_.width) *
              static_cast<std::size_t>(map_.height)) {}

out::Signal OutputCorrection::apply(const out::Signal& picture) {
  assert(picture.width == map_.source_width && picture.height == map_.source_height);
  forBlocks(threads_, static_cast<std::size_t>((map_.height + kRows - 1) / kRows),
            [&](std::size_t block) {
              const int first = static_cast<int>(block) * kRows;
              correct_(map_, picture.pixels.data(), pixels_.data(), first,
                       std::min(first + kRows, map_.height));
            });
  return {map_.width, map_.height, pixels_};
}

}  // namespace merlin::render::correct
