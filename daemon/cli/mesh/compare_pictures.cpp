#include "daemon/cli/mesh/compare_pictures.h"

#include <filesystem>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/mesh/edge_bands.h"
#include "daemon/cli/mesh/mesh.h"
#include "render/content/shown_colours.h"
#include "render/image/picture_difference.h"
#include "render/image/png_writer.h"
#include "render/lod/finest_level.h"

namespace merlin::cli {
namespace {

Result<render::image::Image> drawn(const render::lod::Dendrogram& model, const View& view) {
  const SystemClock clock;
  auto painter = render::frame::OffscreenModel::make(model, view.asAsked(), clock);
  if (!painter) return painter.error();
  return painter->draw(0);
}

Result<Ok> makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", folder, error.message())};
  return checkWritable(folder + "/a.png");
}

Result<Ok> write(const std::string& folder, const char* name, const render::image::Image& image) {
  return render::image::writePng(fmt::format("{}/{}.png", folder, name), image.width, image.height,
                                 image.pixels);
}

}  // namespace

Result<double> writePictures(const std::string& folder, const render::mesh::Mesh& a,
                             const render::mesh::Mesh& b, const View& view) {
  if (const auto made = makeFolder(folder); !made) return made.error();
  const render::lod::Dendrogram first = render::lod::oneLevel(framed(a, b)),
                                second = render::lod::oneLevel(framed(b, a));
  View same = view;
  if (!view.model.show.feature.empty()) {  // uses the same colour scale for both models
    const auto shown = render::content::coloursOf(first, view.model.show);
    if (!shown) return shown.error();
    same.model.show.range = {shown->low, shown->high};
  }
  View wire = same;
  wire.model.style.wireframe = true;
  std::vector<render::image::Image> images;
  for (const auto& [model, how] :
       {std::pair{&first, &same}, {&second, &same}, {&first, &wire}, {&second, &wire}}) {
    auto image = drawn(*model, *how);
    if (!image) return image.error();
    images.push_back(*std::move(image));
  }
  const render::mesh::Mesh bands = framed(edgeBands(b, ranksOf(lengthsInSpace(b)), view), a);
  auto edges = drawn(render::lod::oneLevel(bands), bandView(view));
  if (!edges) return edges.error();
  render::image::Image beside = images[0];
  beside.append(images[1]);
  auto difference = render::image::differenceOf(images[0], images[1], view.model.style.background);
  images.insert(images.end(), {beside, difference.image, *edges});
  constexpr const char* kNames[] = {"a", "b", "a_wire", "b_wire", "beside", "difference", "edges"};
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (const auto written = write(folder, kNames[i], images[i]); !written) return written.error();
  }
  return difference.changed_percent;
}

}  // namespace merlin::cli
