// Elevation maps of any format that GDAL reads: USGS DEM, GTOPO30, GeoTIFF and many more.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/result.h"
#include "render/import/grid_source.h"

namespace merlin::render::import {

// Registers GDAL's readers, but for those that open what a file names: other files, the network, a
// database. To be called once, before the sandbox closes. Errors: kUnsupported.
Result<Ok> prepareGdal();

// Opens a map of one band. `wanted`: in a file with several maps (the variables of netCDF and HDF5,
// the images of a TIFF file), the number of one, from 1, or its variable's name; empty: the first
// image of a TIFF file, and a note lists the others. Its heights and cells become metres by the
// file's own units, cells in degrees stay so (GridHead::latitude_deg); voids become NaN; rows run
// from the north, columns from the west. Errors, with GDAL's words: kMalformed, kUnsupported
// (several bands, too large), kInvalidArgument (several maps of which none is wanted, or no such
// one; the error lists them).
Result<std::unique_ptr<GridSource>> openGdal(const std::string& path, const std::string& wanted);

}  // namespace merlin::render::import
