#include "render/range/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "daemon/base/huge_vector.h"
#include "render/range/cells.h"
#include "render/range/geometry.h"

namespace merlin::render::range {
namespace {

float squaredDistance(const float* a, const float* b) {
  const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
  return x * x + y * y + z * z;
}

class Triangulation {
 public:
  Triangulation(const RangeImage& image, const std::vector<float>& points)
      : image_(image),
        points_(points),
        mirrored_(isMirrored(image)),
        cells_((image.height + 1) * stride(), Cell{0}) {}

  void findCells(const Threshold& max_edge, const Work& work);
  void countVertices(const Work& work);
  void fillVertices(const Work& work);
  void fillFeatures(const Work& work);
  void fillTriangles(const Work& work);
  void fillNormals(const Work& work);
  RangeMesh take() { return std::move(result_); }

 private:
  // Cells are stored with a border of empty cells, so that each pixel has four cells around it. In
  // a full turn, the left border holds the last cell of the row.
  std::size_t stride() const { return image_.width + 1; }
  Cell& cell(std::size_t row, std::size_t column) {
    return cells_[(row + 1) * stride() + column + 1];
  }
  std::size_t cellsInRow() const { return image_.wraps() ? image_.width : image_.width - 1; }
  std::size_t right(std::size_t column) const { return column + 1 < image_.width ? column + 1 : 0; }
  // Returns the pixels at the corners a, b, c, d of a cell.
  std::array<std::size_t, 4> corners(std::size_t row, std::size_t column) const {
    const std::size_t top = row * image_.width, bottom = top + image_.width;
    return {top + column, top + right(column), bottom + right(column), bottom + column};
  }
  Cell cellOf(const std::array<std::size_t, 4>& corners) const;
  bool isAllowed(std::size_t p, std::size_t q, float squared) const {
    return squared <= std::min(squared_limits_[p], squared_limits_[q]);  // false for NaN
  }
  // Returns the edges that triangles at the pixel use, as bits: Fans in cells.h describes `sides`.
  std::uint8_t sidesOf(std::size_t row, std::size_t column) const;
  std::uint32_t vertex(std::size_t pixel, Corner corner) const {
    const unsigned in_ring = corner == kD ? 0U : corner + 1U;
    return first_[pixel] + (unsigned{kFans[sides_[pixel]].of_cell} >> 2 * in_ring & 3U);
  }
  void fillRow(std::size_t row);

  const RangeImage& image_;
  const std::vector<float>& points_;
  bool mirrored_;
  std::vector<Cell> cells_;
  std::vector<float> squared_limits_{};        // by pixel: squared limit of edge lengths
  std::vector<std::uint8_t> sides_{};          // by pixel: see sidesOf()
  std::vector<std::uint32_t> first_{};         // by pixel: index of its first vertex
  std::vector<std::size_t> triangle_start_{};  // by row of cells: index of its first triangle
  RangeMesh result_{};
};

Cell Triangulation::cellOf(const std::array<std::size_t, 4>& corners) const {
  const auto [a, b, c, d] = corners;
  const auto squared = [&](std::size_t p, std::size_t q) {
    return squaredDistance(&points_[3 * p], &points_[3 * q]);
  };
  const auto allows = [&](std::size_t p, std::size_t q) { return isAllowed(p, q, squared(p, q)); };
  const float ac = squared(a, c), bd = squared(b, d);
  if (bd < ac || !(ac == ac)) {  // an end of ac has no return
    if (!isAllowed(b, d, bd)) return 0;
    const bool first = allows(a, d) && allows(a, b), second = allows(d, c) && allows(b, c);
    return static_cast<Cell>(kAcrossBd | (first ? kFirst : 0) | (second ? kSecond : 0));
  }
  if (!isAllowed(a, c, ac)) return 0;
  const bool first = allows(a, d) && allows(d, c), second = allows(a, b) && allows(b, c);
  return static_cast<Cell>((first ? kFirst : 0) | (second ? kSecond : 0));
}

void Triangulation::findCells(const Threshold& max_edge, const Work& work) {
  resizeHuge(squared_limits_, image_.pixels());
  forRows({work.threads}, image_.height, [&](std::size_t row) {
    for (std::size_t p = row * image_.width; p < (row + 1) * image_.width; ++p) {
      const float limit = max_edge.at(image_.range[p]);
      squared_limits_[p] = limit * limit;
    }
  });
  forRows(work, image_.height - 1, [&](std::size_t row) {
    for (std::size_t column = 0; column < cellsInRow(); ++column)
      cell(row, column) = cellOf(corners(row, column));
    if (image_.wraps()) cells_[(row + 1) * stride()] = cell(row, image_.width - 1);
  });
  squared_limits_ = {};
}

std::uint8_t Triangulation::sidesOf(std::size_t row, std::size_t column) const {
  const Cell* above = &cells_[row * stride() + column];
  const Cell* below = above + stride();
  const Cell around[4] = {above[1], below[1], below[0], above[0]};
  unsigned sides = 0;
  for (unsigned i = 0; i < 4; ++i) sides |= unsigned{sidesAt(kRing[i], around[i])} << 2 * i;
  return static_cast<std::uint8_t>(sides);
}

// Numbers the vertices by their pixels, and the triangles by their cells.
void Triangulation::countVertices(const Work& work) {
  resizeHuge(sides_, image_.pixels());
  resizeHuge(first_, image_.pixels());
  struct Row {
    std::size_t vertices = 0, triangles = 0, returns = 0, unused = 0, split = 0;
  };
  std::vector<Row> rows(image_.height);
  forRows(work, image_.height, [&](std::size_t row) {
    Row& counts = rows[row];
    for (std::size_t column = 0; column < image_.width; ++column) {
      const std::size_t pixel = row * image_.width + column;
      sides_[pixel] = sidesOf(row, column);
      const std::size_t fans = kFans[sides_[pixel]].count;
      const bool returned = isReturn(image_.range[pixel]);
      first_[pixel] = static_cast<std::uint32_t>(counts.vertices);  // so far only within the row
      counts.vertices += fans;
      counts.split += fans > 1 ? fans - 1 : 0;
      counts.returns += returned;
      counts.unused += returned && fans == 0;
      const bool has_cell = row + 1 < image_.height && column < cellsInRow();
      const Cell code = has_cell ? cell(row, column) : Cell{0};
      counts.triangles += (code & kFirst ? 1U : 0U) + (code & kSecond ? 1U : 0U);
    }
  });
  std::size_t vertices = 0, triangles = 0;
  for (const Row& row : rows) {
    const std::size_t at = static_cast<std::size_t>(&row - rows.data()) * image_.width;
    for (std::size_t p = at; p < at + image_.width; ++p)
      first_[p] += static_cast<std::uint32_t>(vertices);
    triangle_start_.push_back(triangles);
    vertices += row.vertices;
    triangles += row.triangles;
    result_.returns += row.returns;
    result_.unused += row.unused;
    result_.split += row.split;
  }
  resizeHuge(result_.pixels, vertices);
  resizeHuge(result_.on_boundary, vertices);
  resizeHuge(result_.mesh.positions, 3 * vertices);
  resizeHuge(result_.mesh.triangles, 3 * triangles);
}

void Triangulation::fillVertices(const Work& work) {
  forRows(work, image_.height, [&](std::size_t row) {
    for (std::size_t p = row * image_.width; p < (row + 1) * image_.width; ++p) {
      const std::size_t end = first_[p] + kFans[sides_[p]].count;
      for (std::size_t v = first_[p]; v < end; ++v) {
        result_.pixels[v] = static_cast<std::uint32_t>(p);
        result_.on_boundary[v] = sides_[p] != kClosed;
        for (std::size_t k = 0; k < 3; ++k) result_.mesh.positions[3 * v + k] = points_[3 * p + k];
      }
    }
  });
}

void Triangulation::fillFeatures(const Work& work) {
  constexpr std::size_t kBlock = 1 << 14;
  const std::size_t vertices = result_.pixels.size();
  const std::size_t blocks = (vertices + kBlock - 1) / kBlock;
  for (const Plane& plane : image_.planes) {
    mesh::Feature feature{plane.name, plane.dimension, {}};
    resizeHuge(feature.values, vertices * plane.dimension);
    std::vector<std::size_t> wrong(blocks, 0);
    forRows(work, blocks, [&](std::size_t block) {
      for (std::size_t v = block * kBlock; v < std::min(vertices, (block + 1) * kBlock); ++v) {
        for (std::size_t k = 0; k < plane.dimension; ++k) {
          const float value = plane.values[result_.pixels[v] * plane.dimension + k];
          feature.values[v * plane.dimension + k] = std::isfinite(value) ? value : 0;
          wrong[block] += !std::isfinite(value);
        }
      }
    });
    for (const std::size_t n : wrong) result_.not_numbers += n;
    result_.mesh.features.push_back(std::move(feature));
  }
}

void Triangulation::fillRow(std::size_t row) {
  std::uint32_t* out = result_.mesh.triangles.data() + 3 * triangle_start_[row];
  for (std::size_t column = 0; column < cellsInRow(); ++column) {
    const Cell code = cell(row, column);
    if (code == 0) continue;
    const std::array<std::size_t, 4> pixels = corners(row, column);
    for (std::size_t t = 0; t < 2; ++t) {
      if (!(code & (t == 0 ? kFirst : kSecond))) continue;
      const Corner* corner = kTriangles[code & kAcrossBd][t];
      for (std::size_t k = 0; k < 3; ++k) out[k] = vertex(pixels[corner[k]], corner[k]);
      if (mirrored_) std::swap(out[1], out[2]);
      out += 3;
    }
  }
}

void Triangulation::fillTriangles(const Work& work) {
  forRows(work, image_.height - 1, [&](std::size_t row) { fillRow(row); });
}

// Adds the feature "normal". Processes even rows of cells first, then odd ones: two rows of the
// same kind share no vertex, so that each vertex sums its normals in the same order with any number
// of threads.
void Triangulation::fillNormals(const Work& work) {
  mesh::Mesh& mesh = result_.mesh;
  std::vector<float> normals;
  resizeHuge(normals, mesh.positions.size());
  const auto addRow = [&](std::size_t row) {
    for (std::size_t t = triangle_start_[row]; t < triangle_start_[row + 1]; ++t) {
      const std::uint32_t* v = &mesh.triangles[3 * t];
      const auto at = [&](std::size_t k) { return &mesh.positions[3 * std::size_t{v[k]}]; };
      const auto face = mesh::faceNormal(at(0), at(1), at(2));
      for (std::size_t i = 0; i < 9; ++i) normals[3 * std::size_t{v[i / 3]} + i % 3] += face[i % 3];
    }
  };
  const std::size_t rows = image_.height - 1;
  forRows(partOf(work, 0, 0.5), (rows + 1) / 2, [&](std::size_t i) { addRow(2 * i); });
  forRows(partOf(work, 0.5, 1), rows / 2, [&](std::size_t i) { addRow(2 * i + 1); });
  forEach(work.threads, mesh.vertexCount(), [&](std::size_t vertex) {
    float* n = &normals[3 * vertex];
    const float length = std::sqrt(mesh::dot(n, n));
    for (std::size_t k = 0; k < 3; ++k) n[k] = length > 0 ? n[k] / length : 0;
  });
  mesh.features.insert(mesh.features.begin(), mesh::Feature{"normal", 3, std::move(normals)});
}

}  // namespace

RangeMesh triangulate(const RangeImage& image, const std::vector<float>& points,
                      const Threshold& max_edge, const Work& work) {
  Triangulation t(image, points);
  t.findCells(max_edge, partOf(work, 0, 0.3));
  t.countVertices(partOf(work, 0.3, 0.4));
  t.fillVertices(partOf(work, 0.4, 0.5));
  t.fillFeatures({work.threads});
  t.fillTriangles(partOf(work, 0.5, 0.6));
  t.fillNormals(partOf(work, 0.6, 1));
  return t.take();
}

void addTexcoords(RangeMesh& mesh, const RangeImage& image) {
  mesh::Feature feature{"texcoord", 2, std::vector<float>(2 * mesh.pixels.size())};
  const auto share = [](std::size_t i, std::size_t n) {
    return static_cast<float>((static_cast<double>(i) + 0.5) / static_cast<double>(n));
  };
  for (std::size_t v = 0; v < mesh.pixels.size(); ++v) {
    feature.values[2 * v] = share(mesh.pixels[v] % image.width, image.width);
    feature.values[2 * v + 1] = 1 - share(mesh.pixels[v] / image.width, image.height);
  }
  mesh.mesh.features.push_back(std::move(feature));
}

}  // namespace merlin::render::range
