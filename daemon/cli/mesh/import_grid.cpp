#include "daemon/cli/mesh/import_grid.h"

#include <optional>
#include <utility>

#include "daemon/cli/foreign_import.h"

namespace merlin::cli {

Result<render::range::LoadedRange> readForeignGrid(const ForeignGrid& grid,
                                                   const render::range::RangeOptions& options) {
  std::optional<render::range::LoadedRange> loaded;
  ForeignFile file{"grid", grid.input, grid.output, {}, grid.memory_bytes};
  if (!grid.hdu.empty()) file.options = {"--hdu", grid.hdu};
  if (!grid.variable.empty())
    file.options.insert(file.options.end(), {"--variable", grid.variable});
  const auto report = importForeign(file, [&](const std::string& made) -> Result<Ok> {
    auto read = render::range::readGrid(made, grid.input, options);
    if (!read) return read.error();
    loaded = *std::move(read);
    return Ok{};
  });
  if (!report) return report.error();
  loaded->notes.insert(loaded->notes.end(), report->notes.begin(), report->notes.end());
  return *std::move(loaded);
}

RangeReader readerOf(const std::optional<InputKind>& kind, const ForeignGrid& grid) {
  const bool foreign = kind && kind->isGrid() && kind->reader == InputReader::kForeign;
  return [=](const std::string& path,
             const render::range::RangeOptions& said) -> Result<render::range::LoadedRange> {
    if (foreign)
      return readForeignGrid({path, grid.output, grid.memory_bytes, grid.hdu, grid.variable}, said);
    if (!grid.variable.empty())
      return Error{Errc::kInvalidArgument, path +
                                               ": --variable is for netCDF and other files of "
                                               "several maps, and this file is not one"};
    if (grid.hdu.empty()) return render::range::readRange(path, said);
    return Error{Errc::kInvalidArgument,
                 path + ": --hdu is for FITS files, and this file is not one"};
  };
}

}  // namespace merlin::cli
