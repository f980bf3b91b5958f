#include "render/import/grid_import.h"

#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/import/fits_grid.h"
#include "render/import/gdal_grid.h"

namespace merlin::render::import {
namespace {

Result<std::unique_ptr<GridSource>> openGrid(const GridInput& input) {
  const std::string& in = input.path;
  constexpr std::size_t kBeginning = 80;
  const auto beginning = FileCopy::read(in, kBeginning);
  if (!beginning) return beginning.error();
  const bool fits = isFits(beginning->text());
  if (fits && !input.variable.empty())
    return Error{Errc::kInvalidArgument,
                 "--variable is for netCDF and other files of maps; --hdu names an image of a FITS "
                 "file"};
  if (fits) return openFits(in, input.hdu);
  if (!input.hdu.empty())
    return Error{Errc::kInvalidArgument, "--hdu is for FITS files, and this is not one"};
  // GDAL treats an absolute path as a file; it could interpret other names as addresses or
  // databases.
  std::error_code error;
  const auto path = std::filesystem::absolute(in, error);
  return openGdal(error ? in : path.lexically_normal().string(), input.variable);
}

// Returns the error because of which the grid was not written: the source's message if there is
// one, else the error of writing.
Error fault(const std::string& in, const std::string& reading, const Error& writing) {
  if (!reading.empty()) return {Errc::kMalformed, fmt::format("{}: {}", in, reading)};
  return writing;
}

}  // namespace

Result<Ok> prepareGridImport(const char* /*program*/) { return prepareGdal(); }

std::vector<std::string> gridHeadersBeside(const std::string& input) {
  std::vector<std::string> files;
  const std::size_t dot = input.find_last_of("./");
  if (dot == std::string::npos || input[dot] != '.') return files;
  for (const char* ending : {".hdr", ".HDR", ".prj", ".PRJ", ".blw", ".BLW", ".dmw", ".DMW", ".stx",
                             ".STX", ".tfw", ".TFW"}) {
    std::string file = input.substr(0, dot) + ending;
    if (file != input && fileStamp(file)) files.push_back(std::move(file));
  }
  return files;
}

Result<ImportedGrid> importGrid(const GridInput& input, const std::string& out,
                                const OnGridSize& on_size, const OnGridProgress& on_progress) {
  const std::string& in = input.path;
  const auto source = openGrid(input);
  if (!source) return Error{source.error().code, fmt::format("{}: {}", in, source.error().what)};
  const range::GridHead& head = (*source)->head();
  const ImportedGrid size{head.width, head.height};
  if (const auto may = on_size(size); !may) return may.error();
  std::string reading;
  const auto readRow = [&](std::size_t row, std::span<float> values) {
    reading = (*source)->readRow(row, values);
    if (!reading.empty()) reading = fmt::format("row {} of {}: {}", row, head.height, reading);
    on_progress(static_cast<double>(row) / static_cast<double>(head.height),
                static_cast<std::int64_t>(row * head.width));
    return reading.empty();
  };
  const auto written = writeFile(
      out, [&](const WriteBytes& write) { return range::writeGrid(head, write, readRow); });
  if (!written) return fault(in, reading, written.error());
  return size;
}

}  // namespace merlin::render::import
