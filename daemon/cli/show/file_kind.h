// The kind of a file that `merlin show` is to show, recognised by its content.
#pragma once

#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::cli {

enum class FileKind {
  kModel,    // .mrm
  kPyramid,  // a pyramid made by merlin image import
  kPicture,  // any format that merlin image import reads
  kMesh,     // anything from which merlin mesh import makes a model
  kSlides    // a folder
};

// `as_mesh`: an option of merlin mesh import was given. A PGM, a FITS image and a TIFF can be
// either a picture or ranges and heights: without such an option they are pictures, unless
// saysGeometry(). A file that no other reader accepts is taken for a picture, since only libvips
// knows which formats it reads. Errors: kNotFound, kMalformed (neither a file nor a folder).
Result<FileKind> kindOfFile(const std::string& path, bool as_mesh);

// Whether the header of a PGM or a FITS image states how its pixels become points, or a TIFF is a
// map (it has GeoKeys, and one value per pixel). Pure.
//
// Source: GeoTIFF 1.1 (OGC 19-008r4), section 7.1.1: the tag 34735; TIFF 6.0 (Adobe, 1992).
bool saysGeometry(std::string_view content);

// The name in the content folder for the result of this file: the file's own, with the ending by
// which merlind recognises the result, ".mrm" or ".tif", or without an ending for slides. Errors:
// kInvalidArgument (not a plain name).
Result<std::string> nameInFolder(const std::string& path, FileKind kind);

}  // namespace merlin::cli
