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

// Opens a map of one band. Its heights and cells become metres by the file's own units, cells in
// degrees stay so (GridHead::latitude_deg); voids become NaN; rows run from the north, columns from
// the west. Errors, with GDAL's words: kMalformed, kUnsupported (several bands, too large).
Result<std::unique_ptr<GridSource>> openGdal(const std::string& path);

}  // namespace merlin::render::import
