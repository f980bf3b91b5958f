#include "daemon/import/importers.h"

#include <fmt/format.h>

#include "render/import/vips_pyramid.h"

namespace merlin::import {
namespace {

Result<Imported> importPicture(const Request& request, const Reports& reports) {
  const std::string name = "pyramid.tif";
  const auto made = render::import::importPicture(
      request.input, request.folder + "/" + name,
      {request.panorama, request.quality, request.tile_px},
      [&](const render::import::ImportedPicture& size) {
        return reports.size(3 * static_cast<std::uint64_t>(size.width) *
                            static_cast<std::uint64_t>(size.height));
      },
      reports.progress);
  if (!made) return made.error();
  return Imported{name, fmt::format("\"width\": {}, \"height\": {}", made->width, made->height)};
}

constexpr Importer kImporters[] = {
    {"picture", "a picture of any format that libvips reads, as a tiled pyramid",
     &render::import::prepareImport, &importPicture},
};

}  // namespace

std::span<const Importer> importers() noexcept { return kImporters; }

}  // namespace merlin::import
