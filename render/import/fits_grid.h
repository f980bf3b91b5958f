// Range images and elevation maps in FITS files, by CFITSIO.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/import/grid_source.h"

namespace merlin::render::import {

bool isFits(std::string_view bytes) noexcept;

// Opens the first image of two axes; further axes of length 1 count for nothing. The cards of its
// geometry are in the README of render/range/io. BSCALE, BZERO and BLANK are applied. Errors, with
// the name of the card or CFITSIO's words: kMalformed, kUnsupported (no such image, too large).
Result<std::unique_ptr<GridSource>> openFits(const std::string& path);

}  // namespace merlin::render::import
