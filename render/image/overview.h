// Makes a small picture of a whole pyramid.
#pragma once

#include <memory>

#include "daemon/base/result.h"
#include "render/image/image.h"
#include "render/image/pyramid_file.h"

namespace merlin::render::image {

// Returns one level of the pyramid as one image: the coarsest one whose longer side has at least
// kOverviewSide pixels, or else the finest one. Reads at most 36 tiles: a few milliseconds and 10
// MB. Errors: those of PyramidReader::readTile().
Result<Image> readOverview(std::shared_ptr<const PyramidFile> file);

inline constexpr std::int64_t kOverviewSide = 640;

}  // namespace merlin::render::image
