#include "render/mesh/atlas/join_textures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "render/image/png_writer.h"
#include "render/mesh/atlas/charts.h"
#include "render/mesh/atlas/layout.h"
#include "render/mesh/atlas/paint.h"

namespace merlin::render::mesh {
namespace {

bool repeats(const SurfaceTexture& t) {
  return t.wrap_u == image::Wrap::kRepeat && t.wrap_v == image::Wrap::kRepeat;
}

bool hasTexture(const SurfaceTextures& textures) {
  return std::ranges::any_of(textures.of_triangle, [](auto t) { return t != kNoTexture; });
}

// Returns the picture that all triangles use, if it repeats and its file is known; else nullptr.
const image::ImageFile* onlyPicture(const SurfaceTextures& textures) {
  if (textures.of_triangle.empty() || textures.of_triangle[0] == kNoTexture) return nullptr;
  const SurfaceTexture& first = textures.textures[textures.of_triangle[0]];
  const bool only = std::ranges::all_of(textures.of_triangle, [&](std::uint32_t t) {
    return t != kNoTexture && textures.textures[t] == first;
  });
  return only && repeats(first) && !first.picture->file.empty() ? first.picture : nullptr;
}

// Returns the number of pictures that no triangle uses.
std::size_t unusedPictures(const SurfaceTextures& textures) {
  std::set<const image::ImageFile*> unused;
  for (const SurfaceTexture& t : textures.textures) {
    if (t.picture && !t.picture->pixels.empty()) unused.insert(t.picture);
  }
  std::vector<bool> used(textures.textures.size());
  for (const std::uint32_t t : textures.of_triangle) {
    if (t != kNoTexture) used[t] = true;
  }
  for (std::size_t t = 0; t < used.size(); ++t) {
    if (used[t]) unused.erase(textures.textures[t].picture);
  }
  return unused.size();
}

// Splits vertices so that all triangles at a vertex have the same place in the atlas.
class Splitter {
 public:
  Splitter(Mesh& mesh, const Charts& charts) : mesh_(mesh), charts_(charts) {}

  // Splits the vertices. Returns for each vertex one of its triangles, from which the vertex's
  // place in the atlas follows; kNoTexture if it has no triangle.
  std::vector<std::uint32_t> split() {
    triangle_of_.assign(mesh_.vertexCount(), kNoTexture);
    for (std::uint32_t t = 0; t < charts_.places.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& v = mesh_.triangles[3 * std::size_t{t} + k];
        v = vertexFor(v, t);
      }
    }
    return std::move(triangle_of_);
  }

 private:
  using Key = std::pair<std::uint32_t, std::array<std::int64_t, 4>>;

  std::uint32_t vertexFor(std::uint32_t v, std::uint32_t t) {
    if (triangle_of_[v] == kNoTexture) triangle_of_[v] = t;
    const TrianglePlace& place = charts_.places[t];
    if (charts_.places[triangle_of_[v]] == place) return v;
    const Key key{v, {place.chart, place.colour, place.shift[0], place.shift[1]}};
    const auto next = static_cast<std::uint32_t>(mesh_.vertexCount());
    const auto [found, fresh] = twins_.try_emplace(key, next);
    if (fresh) addTwin(v, t);
    return found->second;
  }

  void addTwin(std::uint32_t v, std::uint32_t t) {
    addCopy(v, mesh_);
    triangle_of_.push_back(t);
  }

  Mesh& mesh_;
  const Charts& charts_;
  std::vector<std::uint32_t> triangle_of_;
  std::map<Key, std::uint32_t> twins_;
};

void setCoordinates(const Charts& charts, const Layout& layout,
                    const std::vector<std::uint32_t>& triangle_of, Feature& texcoord) {
  for (std::size_t v = 0; v < triangle_of.size(); ++v) {
    float* const uv = &texcoord.values[2 * v];
    std::array<float, 2> there{};
    const TrianglePlace place =
        triangle_of[v] == kNoTexture ? TrianglePlace{} : charts.places[triangle_of[v]];
    if (place.chart != kNoTexture) {
      const Chart& chart = charts.charts[place.chart];
      const auto [x, y] =
          texelsOf(*chart.texture.picture, static_cast<double>(uv[0]) - place.shift[0],
                   static_cast<double>(uv[1]) - place.shift[1]);
      there = layout.coordinatesOf(chart, layout.cells[place.chart], x, y);
    } else if (triangle_of[v] != kNoTexture) {
      there = layout.coordinatesOf(place.colour);
    }
    std::ranges::copy(there, uv);
  }
}

// Returns the mean colour of an atlas, in which each chart is weighted by its area. The space
// between the charts gets this colour, so that mipmaps that mix it with charts change little.
Colour meanOfAll(const Charts& charts, const Layout& layout) {
  std::array<double, 3> sum{};
  double all = 0;
  const auto add = [&](const Colour& colour, double area) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += area * colour[k];
    all += area;
  };
  for (std::size_t i = 0; i < charts.charts.size(); ++i)
    add(meanOf(*charts.charts[i].texture.picture),
        static_cast<double>(layout.cells[i].width) * layout.cells[i].height);
  for (const Colour& colour : charts.colours) add(colour, kGutter * kGutter);
  Colour mean{};
  for (std::size_t k = 0; k < 3; ++k)
    mean[k] = static_cast<std::uint8_t>(std::lround(sum[k] / all));
  return mean;
}

std::vector<std::uint8_t> paint(const Charts& charts, const Layout& layout) {
  AtlasPixels atlas{layout.width, layout.height, {}};
  atlas.pixels.resize(std::size_t{3} * static_cast<std::size_t>(layout.width) *
                      static_cast<std::size_t>(layout.height));
  paintColour(meanOfAll(charts, layout), 0, 0, layout.width, layout.height, atlas);
  for (std::size_t i = 0; i < charts.charts.size(); ++i)
    paintChart(charts.charts[i], layout.cells[i], atlas);
  for (std::size_t i = 0; i < charts.colours.size(); ++i) {
    const auto [x, y] = layout.squareOf(i);
    paintColour(charts.colours[i], x, y, kGutter, kGutter, atlas);
  }
  return std::move(atlas.pixels);
}

JoinedTextures reportOf(const Charts& charts, const Layout& layout) {
  JoinedTextures joined;
  joined.pictures = charts.charts.size();
  joined.colours = charts.colours.size();
  joined.width = layout.width;
  joined.height = layout.height;
  joined.scale = layout.scale;
  joined.reduced = layout.reduced;
  joined.mean_coloured = charts.mean_coloured;
  joined.rounded_colours = charts.rounded_colours;
  return joined;
}

JoinedTextures makeAtlas(Mesh& mesh, const SurfaceTextures& textures, const AtlasLimits& limits) {
  const Charts charts = findCharts(mesh, textures, limits);
  JoinedTextures joined;
  const auto layout = layOut(charts, limits);
  if (!layout) {
    joined.baked = true;
    return joined;
  }
  auto file = image::encodePng(layout->width, layout->height, paint(charts, *layout));
  if (!file) {
    joined.baked = true;
    return joined;
  }
  joined = reportOf(charts, *layout);
  const std::size_t before = mesh.vertexCount();
  const auto triangle_of = Splitter(mesh, charts).split();
  joined.split = mesh.vertexCount() - before;
  setCoordinates(charts, *layout, triangle_of, *mesh.find("texcoord"));
  mesh.texture = *std::move(file);
  return joined;
}

std::string counted(std::size_t n, const char* one, const char* several) {
  return fmt::format("{} {}", n, n == 1 ? one : several);
}

}  // namespace

std::vector<std::string> JoinedTextures::notes() const {
  if (!baked && pictures + colours == 0 && unused == 0) return {};
  const std::string left_out = unused == 0
                                   ? std::string()
                                   : counted(unused, "texture is on no triangle and is left out",
                                             "textures are on no triangle and are left out");
  std::vector<std::string> all;
  if (baked) {
    all = {"its textures are too many for one picture: they are baked into the vertices' colours"};
    if (unused > 0) all.push_back(left_out);
    return all;
  }
  if (pictures + colours == 0)
    return {"the texture that is on all triangles is kept as it is; " + left_out};
  std::string text = counted(pictures, "texture", "textures");
  if (colours > 0) text += " and " + counted(colours, "plain colour", "plain colours");
  text +=
      fmt::format("{} of {} x {} pixels",
                  pictures + colours > 1 ? " became one" : " is kept as a picture", width, height);
  if (scale < 1) text += fmt::format("; each was made smaller, to {:.0f} %", 100 * scale);
  all.push_back(std::move(text));
  if (reduced > 0)
    all.push_back(fmt::format("{} made smaller, since they are repeated often",
                              counted(reduced, "texture was", "textures were")));
  if (mean_coloured > 0)
    all.push_back(fmt::format("{} the mean colour of their texture, which they repeat too often",
                              counted(mean_coloured, "triangle has", "triangles have")));
  if (rounded_colours > 0)
    all.push_back(fmt::format("{} without texture in rounded colours, since there are too many",
                              counted(rounded_colours, "triangle is", "triangles are")));
  if (unused > 0) all.push_back(left_out);
  return all;
}

JoinedTextures joinTextures(Mesh& mesh, const SurfaceTextures& textures,
                            const AtlasLimits& limits) {
  assert(textures.of_triangle.size() == mesh.triangleCount());
  if (!hasTexture(textures)) return {};
  assert(mesh.find("texcoord") && mesh.find("texcoord")->dimension == 2);
  if (const image::ImageFile* const picture = onlyPicture(textures)) {
    mesh.texture = picture->file;
    JoinedTextures joined;
    joined.unused = unusedPictures(textures);
    return joined;
  }
  JoinedTextures joined = makeAtlas(mesh, textures, limits);
  joined.unused = unusedPictures(textures);
  return joined;
}

}  // namespace merlin::render::mesh
