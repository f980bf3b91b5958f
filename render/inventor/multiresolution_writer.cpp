// Writes SoMRFaceSet files. Every declared field is written with a value, because Coin without the
// module requires that.
#include "render/inventor/multiresolution_writer.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/inventor_text.h"

namespace merlin::render::inventor {
namespace {

constexpr const char* kTextureName = "MERLIN_TEXTURE";  // name of the texture's node

struct ModelField {
  const char* field;
  const char* type;
  const char* feature;
  std::size_t dimension;
};
constexpr ModelField kFeatureFields[] = {{"normal", "MFVec3f", "normal", 3},
                                         {"diffuseColor", "MFColor", "colour", 3},
                                         {"texCoord", "MFVec2f", "texcoord", 2}};

struct WrittenField {
  const ModelField* field;
  const lod::FeatureView* feature;
};

const lod::FeatureView* featureOf(const lod::Dendrogram& model, const ModelField& field) {
  const lod::FeatureView* found = model.find(field.feature);
  return found && found->dimension == field.dimension ? found : nullptr;
}

// Returns the fields that the file gets. As in a file of one resolution, a textured model has no
// colours, since viewers multiply the texture by them.
std::vector<WrittenField> fieldsOf(const lod::Dendrogram& model, bool textured) {
  std::vector<WrittenField> fields;
  for (const ModelField& field : kFeatureFields) {
    const lod::FeatureView* const feature = featureOf(model, field);
    if (feature && !(textured && feature->name == "colour")) fields.push_back({&field, feature});
  }
  return fields;
}

// Writes the declaration by which a program without the module reads the fields.
void printDeclaration(mesh::TextSink& out, std::span<const WrittenField> fields) {
  out.print(
      "    fields [ SFInt32 minimumResolution, SFInt32 maximumResolution, SFInt32 "
      "currentResolution,\n      SFFloat desiredFrameRate, SFNode alternateRep, MFVec3f vertex");
  for (const WrittenField& f : fields) out.print(", {} {}", f.field->type, f.field->field);
  out.print(
      ",\n      MFInt32 faces, MFInt32 parents, MFInt32 aliveCounts, MFFloat levelErrors ]\n");
}

void printRows(mesh::TextSink& out, const char* field, std::span<const float> values,
               std::size_t width) {
  out.print("    {} [\n", field);
  out.printRows(values, width, "      ", ",\n");
  out.print("    ]\n");
}

void printWhole(mesh::TextSink& out, const char* field, std::span<const std::uint32_t> values) {
  constexpr std::size_t kALine = 12;
  out.print("    {} [", field);
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.print("{}{},", i % kALine == 0 ? "\n      " : " ", values[i]);
  }
  out.print("\n    ]\n");
}

// The data besides the model: the plain surface for programs without the module, and the texture
// image of both.
struct Beside {
  mesh::Mesh plain;
  std::vector<mesh::CompanionFile> picture;  // one entry, or none
};

bool write(const lod::Dendrogram& model, std::span<const WrittenField> fields, const Beside& beside,
           const WriteBytes& bytes) {
  mesh::TextSink out(bytes);
  const lod::Dendrogram::Arrays& a = model.arrays();
  out.print("{}Separator {{\n{}", mesh::kInventorHeader, mesh::kInventorHints);
  const bool textured = !beside.picture.empty();
  if (textured) out.print("  DEF {} {}\n", kTextureName, mesh::textureNode(beside.picture[0].name));
  out.print("  SoMRFaceSet {{\n");
  printDeclaration(out, fields);
  out.print(
      "    minimumResolution {}\n    maximumResolution {}\n    currentResolution {}\n"
      "    desiredFrameRate {}\n    alternateRep ",
      a.alive.back(), a.alive.front(), a.alive.front(), kWrittenFrameRate_hz);
  // The plain surface refers to the texture node, so that viewers read its image only once.
  mesh::printSeparator(out, beside.plain, textured ? fmt::format("USE {}", kTextureName) : "");
  printRows(out, "vertex", a.positions, 3);
  for (const WrittenField& f : fields)
    printRows(out, f.field->field, f.feature->values, f.field->dimension);
  printWhole(out, "faces", a.triangles);
  printWhole(out, "parents", a.parents);
  printWhole(out, "aliveCounts", a.alive);
  printRows(out, "levelErrors", a.error, 1);
  out.print("  }}\n}}\n");
  return out.finish();
}

Result<Ok> checkSize(const std::string& path, const lod::Dendrogram& model) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (model.triangleCount() == 0) {
    return Error{Errc::kUnsupported, path + ": the model has no triangles; nothing is written"};
  }
  if (model.nodeCount() > kMost || model.arrays().triangles.size() > kMost) {
    return Error{
        Errc::kUnsupported,
        fmt::format("{}: {} nodes and {} triangle corners; Open Inventor allows at most {} of each",
                    path, model.nodeCount(), model.arrays().triangles.size(), kMost)};
  }
  return Ok{};
}

}  // namespace

Result<mesh::WrittenMesh> writeMultiresolution(const std::string& path,
                                               const lod::Dendrogram& model) {
  if (const auto fits = checkSize(path, model); !fits) return fits.error();
  Beside beside{lod::extract(model, model.levelFor(kAlternateTriangles)), {}};
  if (auto picture = mesh::pictureBeside(beside.plain, path))
    beside.picture.push_back(*std::move(picture));
  const std::vector<WrittenField> fields = fieldsOf(model, !beside.picture.empty());
  const auto done = mesh::writeBeside(beside.picture, [&] {
    return writeFile(path,
                     [&](const WriteBytes& bytes) { return write(model, fields, beside, bytes); });
  });
  if (!done) return done.error();
  mesh::WrittenMesh written{"iv", {}, {}, {}};
  for (const mesh::CompanionFile& file : beside.picture) written.companions.push_back(file.path);
  for (const lod::FeatureView& f : model.arrays().features) {
    const auto carries = [&](const WrittenField& field) { return field.feature == &f; };
    if (std::none_of(fields.begin(), fields.end(), carries)) written.left_out.push_back(f.name);
  }
  if (!model.arrays().texture.empty() && beside.picture.empty())
    written.left_out.emplace_back("the texture image");
  return written;
}

}  // namespace merlin::render::inventor
