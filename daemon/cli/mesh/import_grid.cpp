#include "daemon/cli/mesh/import_grid.h"

#include <optional>
#include <utility>

#include "daemon/cli/foreign_import.h"

namespace merlin::cli {

Result<render::range::LoadedRange> readForeignGrid(const ForeignGrid& grid,
                                                   const render::range::RangeOptions& options) {
  std::optional<render::range::LoadedRange> loaded;
  const ForeignFile file{"grid", grid.input, grid.output, {}, grid.memory_bytes};
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

RangeReader readerOf(const std::optional<InputKind>& kind, const std::string& output,
                     std::uint64_t memory_bytes) {
  if (!kind || !kind->isGrid() || kind->reader != InputReader::kForeign)
    return render::range::readRange;
  return [=](const std::string& path, const render::range::RangeOptions& said) {
    return readForeignGrid({path, output, memory_bytes}, said);
  };
}

}  // namespace merlin::cli
