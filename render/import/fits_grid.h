// Reads range images and elevation maps in FITS files, through CFITSIO.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/import/grid_source.h"

namespace merlin::render::import {

bool isFits(std::string_view bytes) noexcept;

// Opens an image of two axes; further axes of length 1 are ignored. `wanted`: the image's number (0
// is the primary one) or its EXTNAME; empty: the first image, and a note lists the others. The
// cards that describe the geometry are listed in the README of render/range/io. BSCALE, BZERO and
// BLANK are applied. Errors, with the name of the card or CFITSIO's message: kMalformed,
// kUnsupported (no image at all, too large), kInvalidArgument (no such image; the error lists the
// existing ones).
Result<std::unique_ptr<GridSource>> openFits(const std::string& path, const std::string& wanted);

}  // namespace merlin::render::import
