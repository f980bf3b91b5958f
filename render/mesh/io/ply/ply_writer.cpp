// PLY, binary little-endian: colours as bytes, labels as integers, all else as floats.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "render/mesh/io/ply/ply_features.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace ply {
namespace {

// Names of the PLY properties that a feature is written as, one for each dimension.
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

enum class Form { kFloat, kByte, kInteger };

// Colours are written as bytes, labels as integers if all their values are whole numbers.
Form formOf(const Feature& f) {
  if (f.name == "colour" && f.dimension == 3) return Form::kByte;
  const auto whole = [](float x) { return x == std::floor(x) && std::abs(x) < 2147483648.0F; };
  const bool label = f.name == "label" && std::all_of(f.values.begin(), f.values.end(), whole);
  return label ? Form::kInteger : Form::kFloat;
}

void append(std::string& row, float value, Form form) {
  switch (form) {
    case Form::kFloat: appendLeFloat(row, value); return;
    case Form::kByte:
      row.push_back(static_cast<char>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)));
      return;
    case Form::kInteger:
      appendLe32(row, static_cast<std::uint32_t>(static_cast<std::int32_t>(value)));
      return;
  }
}

// The texture image is named in a comment, as MeshLab does it.
std::string headerFor(const Mesh& mesh, const std::string& name, const std::vector<Form>& forms) {
  constexpr const char* kTypes[] = {"float", "uchar", "int"};
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by MERLIN\n{}element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      isTextured(mesh) ? "comment TextureFile " + pictureName(mesh, name) + "\n" : "",
      mesh.vertexCount());
  for (std::size_t f = 0; f < forms.size(); ++f) {
    for (const std::string& property : propertiesOf(mesh.features[f]))
      text += fmt::format("property {} {}\n", kTypes[static_cast<std::size_t>(forms[f])], property);
  }
  return text + fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                            mesh.triangleCount());
}

bool carries(const Mesh&, const Feature&) { return true; }

bool write(const Mesh& mesh, const std::string& name, const WriteBytes& bytes) {
  std::vector<Form> forms;
  for (const Feature& f : mesh.features) forms.push_back(formOf(f));
  std::string row = headerFor(mesh, name, forms);
  const auto put = [&] { return bytes(std::as_bytes(std::span(row))); };
  if (!put()) return false;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    row.clear();
    for (std::size_t k = 0; k < 3; ++k) appendLeFloat(row, mesh.positions[3 * v + k]);
    for (std::size_t f = 0; f < forms.size(); ++f) {
      const Feature& feature = mesh.features[f];
      for (std::size_t k = 0; k < feature.dimension; ++k)
        append(row, feature.values[v * feature.dimension + k], forms[f]);
    }
    if (!put()) return false;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    row.assign(1, '\3');
    for (std::size_t k = 0; k < 3; ++k) appendLe32(row, mesh.triangles[t + k]);
    if (!put()) return false;
  }
  return true;
}

}  // namespace
}  // namespace ply

const MeshWriter kPlyWriter{"ply", ply::carries, ply::write, PicturePlace::kCompanionFile};

}  // namespace merlin::render::mesh
