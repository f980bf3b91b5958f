// Writes binary little-endian PLY: colours as bytes, labels as integers, coordinates with an origin
// as doubles, all else as floats.
#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "render/mesh/io/ply_features.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace ply {
namespace {

// Returns the names of the PLY properties as which a feature is written, one per dimension.
std::vector<std::string> propertiesOf(const Feature& f) {
  std::vector<std::string> names(f.dimension);
  for (const PropertyMapping& k : kPropertyMappings) {
    if (f.name == k.feature && f.dimension == k.dimension && names[k.offset].empty()) {
      names[k.offset] = k.property;
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) names[i] = f.dimension == 1 ? f.name : fmt::format("{}_{}", f.name, i);
  }
  return names;
}

enum class Form { kFloat, kByte, kInteger, kDouble };

// Returns the type as which a feature is written: colours are bytes, labels are integers if all
// their values are whole numbers, all else are floats.
Form formOf(const Feature& f) {
  if (f.name == "colour" && f.dimension == 3) return Form::kByte;
  const auto whole = [](float x) { return x == std::floor(x) && std::abs(x) < 2147483648.0F; };
  const bool label = f.name == "label" && std::all_of(f.values.begin(), f.values.end(), whole);
  return label ? Form::kInteger : Form::kFloat;
}

// Approximate number of bytes written at a time.
constexpr std::size_t kBlock = std::size_t{1} << 18;

std::size_t sizeOf(Form form) {
  constexpr std::size_t kSizes[] = {4, 1, 4, 8};
  return kSizes[static_cast<std::size_t>(form)];
}

const char* nameOf(Form form) {
  constexpr const char* kNames[] = {"float", "uchar", "int", "double"};
  return kNames[static_cast<std::size_t>(form)];
}

// Returns the type of the coordinates: if an origin is added to them, they do not fit into floats.
Form formOf(const Origin& origin) { return origin == Origin{} ? Form::kFloat : Form::kDouble; }

void store(std::uint8_t* p, float value, Form form, double origin) {
  switch (form) {
    case Form::kFloat: storeLeFloat(p, value); return;
    case Form::kByte: {
      const float level = std::clamp(value, 0.0F, 1.0F) * 255;
      // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround() takes much longer
      *p = static_cast<std::uint8_t>(double{level} + 0.5);
      return;
    }
    case Form::kInteger:
      storeLe32(p, static_cast<std::uint32_t>(static_cast<std::int32_t>(value)));
      return;
    case Form::kDouble: {
      const auto bits = std::bit_cast<std::uint64_t>(value + origin);
      storeLe32(p, static_cast<std::uint32_t>(bits & 0xFFFFFFFF));
      storeLe32(p + 4, static_cast<std::uint32_t>(bits >> 32));
      return;
    }
  }
}

// A table of values of the vertices (positions or a feature), and its place in an output row.
struct ValueTable {
  const float* values;
  std::size_t dimension, offset;
  Form form;
  Origin origin{};  // added to the values if form is kDouble
};

// Writes `rows` rows of `size` bytes, each filled by `fill`, in blocks.
template <typename Fill>
bool writeRows(const WriteBytes& bytes, std::size_t rows, std::size_t size, const Fill& fill) {
  const std::size_t in_a_block = kBlock / size + 1;
  std::vector<std::uint8_t> block(in_a_block * size);
  for (std::size_t first = 0; first < rows; first += in_a_block) {
    const std::size_t n = std::min(in_a_block, rows - first);
    for (std::size_t i = 0; i < n; ++i) fill(first + i, &block[i * size]);
    if (!bytes(std::as_bytes(std::span(block.data(), n * size)))) return false;
  }
  return true;
}

bool writeVertices(const Mesh& mesh, const Origin& origin, const std::vector<Form>& forms,
                   const WriteBytes& bytes) {
  std::vector<ValueTable> columns = {{mesh.positions.data(), 3, 0, formOf(origin), origin}};
  std::size_t size = 3 * sizeOf(formOf(origin));
  for (std::size_t f = 0; f < forms.size(); ++f) {
    const Feature& feature = mesh.features[f];
    columns.push_back({feature.values.data(), feature.dimension, size, forms[f]});
    size += feature.dimension * sizeOf(forms[f]);
  }
  return writeRows(bytes, mesh.vertexCount(), size, [&](std::size_t v, std::uint8_t* row) {
    for (const ValueTable& column : columns) {
      const std::size_t step = sizeOf(column.form);
      const float* values = column.values + v * column.dimension;
      for (std::size_t k = 0; k < column.dimension; ++k)
        store(row + column.offset + k * step, values[k], column.form,
              column.form == Form::kDouble ? column.origin[k] : 0);
    }
  });
}

bool writeTriangles(const Mesh& mesh, const WriteBytes& bytes) {
  return writeRows(bytes, mesh.triangleCount(), 13, [&](std::size_t t, std::uint8_t* row) {
    row[0] = 3;
    for (std::size_t k = 0; k < 3; ++k) storeLe32(row + 1 + 4 * k, mesh.triangles[3 * t + k]);
  });
}

// Returns the header. A comment names the texture image, as in files of MeshLab.
std::string headerFor(const Mesh& mesh, const Origin& origin, const std::string& name,
                      const std::vector<Form>& forms) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by MERLIN\n{0}element vertex {1}\n"
      "property {2} x\nproperty {2} y\nproperty {2} z\n",
      isTextured(mesh) ? "comment TextureFile " + pictureName(mesh, name) + "\n" : "",
      mesh.vertexCount(), nameOf(formOf(origin)));
  for (std::size_t f = 0; f < forms.size(); ++f) {
    for (const std::string& property : propertiesOf(mesh.features[f]))
      text += fmt::format("property {} {}\n", nameOf(forms[f]), property);
  }
  return text + fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                            mesh.triangleCount());
}

bool carries(const Mesh&, const Feature&) { return true; }

bool write(const Mesh& mesh, const Origin& origin, const std::string& name,
           const WriteBytes& bytes) {
  std::vector<Form> forms;
  for (const Feature& f : mesh.features) forms.push_back(formOf(f));
  const std::string header = headerFor(mesh, origin, name, forms);
  return bytes(std::as_bytes(std::span(header))) && writeVertices(mesh, origin, forms, bytes) &&
         writeTriangles(mesh, bytes);
}

}  // namespace
}  // namespace ply

const MeshWriter kPlyWriter{"ply", ply::carries, ply::write, PicturePlace::kCompanionFile, true};

}  // namespace merlin::render::mesh
