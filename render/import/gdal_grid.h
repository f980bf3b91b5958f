// Reads elevation maps of any format that GDAL supports: USGS DEM, GTOPO30, GeoTIFF and many more.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "render/import/grid_source.h"

namespace merlin::render::import {

// Registers GDAL's readers, except readers that open other sources that a file names: other files,
// the network, a database. Call once, before the sandbox closes. Errors: kUnsupported.
Result<Ok> prepareGdal();

// Opens a map of one band. `wanted`: for a file with several maps (the variables of netCDF and
// HDF5, the images of a TIFF file), the map's number, counted from 1, or the name of its variable.
// If `wanted` is empty, a TIFF file gives its first image, and a note lists the others. Heights and
// cells are converted to metres by the file's own units, but cells in degrees stay in degrees
// (GridHead::latitude_deg); missing heights become NaN; rows run from the north, columns from the
// west. Errors, with GDAL's message: kMalformed, kUnsupported (several bands, too large),
// kInvalidArgument (`wanted` is empty but the file has several maps, or there is no such map; the
// error lists them).
Result<std::unique_ptr<GridSource>> openGdal(const std::string& path, const std::string& wanted);

}  // namespace merlin::render::import
