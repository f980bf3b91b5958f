// What a file is that `merlin show` is to show, by its content.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::cli {

enum class FileKind {
  kModel,    // .mrm
  kPyramid,  // of merlin image import
  kPicture,  // of any format that merlin image import reads
  kMesh,     // anything that merlin mesh import makes a model of
  kSlides    // a folder
};

// `as_mesh`: an option of merlin mesh import was given. A PGM, a FITS image and a TIFF can be
// either a picture or ranges and heights: without such an option they are pictures, unless
// saysGeometry(). A file that nobody else reads is taken for a picture, since only libvips knows
// what it reads. Errors: kNotFound, kMalformed (neither a file nor a folder).
Result<FileKind> kindOfFile(const std::string& path, bool as_mesh);

// Whether a PGM's or a FITS image's header says how its pixels become points, or a TIFF is a map
// (it has GeoKeys, and one value per pixel). Pure.
//
// Source: GeoTIFF 1.1 (OGC 19-008r4), section 7.1.1: the tag 34735; TIFF 6.0 (Adobe, 1992).
bool saysGeometry(std::string_view content);

// The name in the content folder of what is made of this file: its own, with the ending that
// merlind knows it by, ".mrm" or ".tif"; of slides none. Errors: kInvalidArgument (not a plain
// name).
Result<std::string> nameInFolder(const std::string& path, FileKind kind);

}  // namespace merlin::cli
