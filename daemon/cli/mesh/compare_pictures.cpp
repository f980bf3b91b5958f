#include "daemon/cli/mesh/compare_pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/mesh/mesh.h"
#include "render/content/shown_colours.h"
#include "render/image/picture_difference.h"
#include "render/image/png_writer.h"
#include "render/lod/finest_level.h"

namespace merlin::cli {
namespace {

constexpr float kBand = 0.25F;  // width of a band, as a share of the distance from edge to centroid
const Eigen::Vector3f kInside{0.1F, 0.1F, 0.12F};  // colour between the bands

// Adds two opposite corners of the other mesh's bounding box as vertices without a triangle. A
// model is scaled by the bounding box of its vertices, so both meshes are then drawn at the same
// scale.
render::mesh::Mesh framed(render::mesh::Mesh mesh, const render::mesh::Mesh& other) {
  render::mesh::ensureNormals(mesh);
  const render::mesh::Box box = render::mesh::boundingBox(other.positions);
  for (const auto& corner : {box.low, box.high}) {
    mesh.positions.insert(mesh.positions.end(), corner.begin(), corner.end());
    for (render::mesh::Feature& f : mesh.features)
      f.values.insert(f.values.end(), f.dimension, 0.0F);
  }
  return mesh;
}

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

// Colour scale from red (0) through yellow, green and cyan to blue (1).
Eigen::Vector3f rainbow(float share) {
  const float at = 4 * std::clamp(share, 0.0F, 1.0F);
  const auto ramp = [at](float middle) {
    return std::clamp(2 - std::abs(at - middle), 0.0F, 1.0F);
  };
  return {std::clamp(2 - at, 0.0F, 1.0F), ramp(2), std::clamp(at - 2, 0.0F, 1.0F)};
}

using Corners = std::array<Eigen::Vector3f, 3>;

Corners cornersOf(const render::mesh::Mesh& mesh, std::size_t triangle) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = Eigen::Map<const Eigen::Vector3f>(
        &mesh.positions[3 * std::size_t{mesh.triangles[3 * triangle + k]}]);
  return corners;
}

float lengthOf(const Corners& corners, std::size_t edge) {
  return (corners[(edge + 1) % 3] - corners[edge]).norm();
}

// The lengths of all edges, sorted; an edge that two triangles share counts twice.
std::vector<float> lengthsOf(const render::mesh::Mesh& mesh) {
  std::vector<float> lengths;
  lengths.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const Corners corners = cornersOf(mesh, t);
    for (std::size_t edge = 0; edge < 3; ++edge) lengths.push_back(lengthOf(corners, edge));
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

// Rank of a length among the sorted `lengths`, 0..1; equal lengths have one rank, that of their
// middle, and so one colour.
float rankOf(const std::vector<float>& lengths, float length) {
  const auto [first, last] = std::equal_range(lengths.begin(), lengths.end(), length);
  const auto sum = static_cast<float>((first - lengths.begin()) + (last - lengths.begin()));
  return sum / (2 * static_cast<float>(lengths.size()));
}

// Collects polygons, each with its own colour, into a mesh; all vertices have the same normal.
class Polygons {
 public:
  explicit Polygons(const Eigen::Vector3f& normal) : normal_(normal) {}

  void add(std::initializer_list<Eigen::Vector3f> corners, const Eigen::Vector3f& colour) {
    const auto first = static_cast<std::uint32_t>(positions_.size() / 3);
    for (const Eigen::Vector3f& corner : corners) {
      positions_.insert(positions_.end(), corner.begin(), corner.end());
      normals_.insert(normals_.end(), normal_.begin(), normal_.end());
      colours_.insert(colours_.end(), colour.begin(), colour.end());
    }
    for (std::uint32_t k = 2; k < corners.size(); ++k)
      triangles_.insert(triangles_.end(), {first, first + k - 1, first + k});
  }
  render::mesh::Mesh mesh() && {
    return {std::move(positions_),
            {{"normal", 3, std::move(normals_)}, {"colour", 3, std::move(colours_)}},
            std::move(triangles_)};
  }

 private:
  Eigen::Vector3f normal_;
  std::vector<float> positions_, normals_, colours_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace

render::mesh::Mesh edgeBands(const render::mesh::Mesh& mesh, const View& view) {
  const std::vector<float> lengths = lengthsOf(mesh);
  // Direction to the renderer's light: surfaces with this normal are drawn in their full colour.
  const Eigen::Vector3f light = Eigen::Vector3f(0.15F, 0.35F, 1).normalized();
  Polygons polygons(view.T_eye_model().linear().transpose() * light);
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const Corners outer = cornersOf(mesh, t);
    const Eigen::Vector3f middle = (outer[0] + outer[1] + outer[2]) / 3;
    Corners inner = outer;
    for (Eigen::Vector3f& corner : inner) corner += kBand * (middle - corner);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      polygons.add({outer[i], outer[j], inner[j], inner[i]},
                   rainbow(rankOf(lengths, lengthOf(outer, i))));
    }
    polygons.add({inner[0], inner[1], inner[2]}, kInside);
  }
  return std::move(polygons).mesh();
}

Result<double> writePictures(const std::string& folder, const render::mesh::Mesh& a,
                             const render::mesh::Mesh& b, const View& view) {
  if (const auto made = makeFolder(folder); !made) return made.error();
  const render::lod::Dendrogram first = render::lod::oneLevel(framed(a, b)),
                                second = render::lod::oneLevel(framed(b, a));
  View same = view;
  if (!view.model.show.feature.empty()) {  // the same colour scale for both models
    const auto shown = render::content::coloursOf(first, view.model.show);
    if (!shown) return shown.error();
    same.model.show.range = {shown->low, shown->high};
  }
  View wire = same, plain = same;
  wire.model.style.wireframe = true;
  plain.model.style.brightness = 1;
  plain.model.show = {};
  std::vector<render::image::Image> images;
  for (const auto& [model, how] :
       {std::pair{&first, &same}, {&second, &same}, {&first, &wire}, {&second, &wire}}) {
    auto image = drawn(*model, *how);
    if (!image) return image.error();
    images.push_back(*std::move(image));
  }
  auto edges = drawn(render::lod::oneLevel(framed(edgeBands(b, view), a)), plain);
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
