// Every declared field is written with a value: Coin without the module requires that.
#include "render/inventor/multiresolution_writer.h"

#include <cstdint>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/mesh/io/inventor_text.h"

namespace merlin::render::inventor {
namespace {

struct ModelField {
  const char* field;
  const char* type;
  const char* feature;
  std::size_t dimension;
};
constexpr ModelField kFeatureFields[] = {{"normal", "MFVec3f", "normal", 3},
                                         {"diffuseColor", "MFColor", "colour", 3},
                                         {"texCoord", "MFVec2f", "texcoord", 2}};

const lod::FeatureView* featureOf(const lod::Dendrogram& model, const ModelField& field) {
  const lod::FeatureView* found = model.find(field.feature);
  return found && found->dimension == field.dimension ? found : nullptr;
}

// Writes the declaration by which a program without the module reads the fields.
void printDeclaration(mesh::TextSink& out, const lod::Dendrogram& model) {
  out.print(
      "    fields [ SFInt32 minimumResolution, SFInt32 maximumResolution, SFInt32 "
      "currentResolution,\n      SFFloat desiredFrameRate, SFNode alternateRep, MFVec3f vertex");
  for (const ModelField& field : kFeatureFields) {
    if (featureOf(model, field)) out.print(", {} {}", field.type, field.field);
  }
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

bool write(const lod::Dendrogram& model, const WriteBytes& bytes) {
  mesh::TextSink out(bytes);
  const lod::Dendrogram::Arrays& a = model.arrays();
  out.print("{}Separator {{\n{}  SoMRFaceSet {{\n", mesh::kInventorHeader, mesh::kInventorHints);
  printDeclaration(out, model);
  out.print(
      "    minimumResolution {}\n    maximumResolution {}\n    currentResolution {}\n"
      "    desiredFrameRate {}\n    alternateRep ",
      a.alive.back(), a.alive.front(), a.alive.front(), kWrittenFrameRate_hz);
  mesh::printSeparator(out, lod::extract(model, model.levelFor(kAlternateTriangles)));
  printRows(out, "vertex", a.positions, 3);
  for (const ModelField& field : kFeatureFields) {
    if (const lod::FeatureView* f = featureOf(model, field)) {
      printRows(out, field.field, f->values, field.dimension);
    }
  }
  printWhole(out, "faces", a.triangles);
  printWhole(out, "parents", a.parents);
  printWhole(out, "aliveCounts", a.alive);
  printRows(out, "levelErrors", a.error, 1);
  out.print("  }}\n}}\n");
  return out.finish();
}

}  // namespace

Result<std::vector<std::string>> writeMultiresolution(const std::string& path,
                                                      const lod::Dendrogram& model) {
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
  const auto done = writeFile(path, [&](const WriteBytes& bytes) { return write(model, bytes); });
  if (!done) return done.error();
  std::vector<std::string> left_out;
  for (const lod::FeatureView& f : model.arrays().features) {
    bool carried = false;
    for (const ModelField& field : kFeatureFields) carried |= featureOf(model, field) == &f;
    if (!carried) left_out.push_back(f.name);
  }
  return left_out;
}

}  // namespace merlin::render::inventor
