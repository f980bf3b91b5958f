// Recognises by its content the kind of a file that `merlin show` is to show.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::cli {

enum class FileKind {
  kModel,    // a multiresolution model (.mrm)
  kPyramid,  // a pyramid made by merlin image import
  kPicture,  // any format that merlin image import reads
  kMesh,     // any format from which merlin mesh import makes a model
  kSlides    // a folder
};

// Returns the kind of a file or folder. `as_mesh`: whether an option of merlin mesh import was
// given; any file is then a mesh. A PGM, a FITS image or a TIFF may contain a picture, or ranges or
// heights; it counts as a picture unless saysGeometry(). A file that no other reader accepts counts
// as a picture, because only libvips knows which formats it can read. Errors: kNotFound, kMalformed
// (neither a file nor a folder).
Result<FileKind> kindOfFile(const std::string& path, bool as_mesh);

// Returns whether the header of a PGM or a FITS image states how its pixels become points, or a
// TIFF is a map (with GeoKeys and one value per pixel). Pure.
//
// Source: GeoTIFF 1.1 (OGC 19-008r4), section 7.1.1: the tag 34735; TIFF 6.0 (Adobe, 1992).
bool saysGeometry(std::string_view content);

// Returns the name in the content folder for the converted file: the name of the file with the
// ending by which merlind recognises the kind, ".mrm" or ".tif"; for slides, the name of the
// folder. Errors: kInvalidArgument (not a plain name).
Result<std::string> nameInFolder(const std::string& path, FileKind kind);

}  // namespace merlin::cli
