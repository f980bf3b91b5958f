// Writes Open Inventor 2.1 ASCII. Normals, colours and texture coordinates are bound per indexed
// vertex; they have no own index lists, so coordIndex applies to them. Source: J. Wernecke, "The
// Inventor Mentor", 1994.
#include <fmt/format.h>

#include "render/mesh/io/inventor_text.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

// Prints "Node { field [ a b c, ... ] }" with `width` values per row.
void printNode(TextSink& out, std::string_view node, std::string_view field,
               const std::vector<float>& values, std::size_t width) {
  out.print("  {} {{\n    {} [\n", node, field);
  out.printRows(values, width, "      ", ",\n");
  out.print("    ]\n  }}\n");
}

bool carries(const Mesh& mesh, const Feature& f) {
  return isUsual(f) && !(f.name == "colour" && isTextured(mesh));
}

bool write(const Mesh& mesh, const Origin&, const std::string& name, const WriteBytes& bytes) {
  TextSink out(bytes);
  out.print("{}", kInventorHeader);
  printSeparator(out, mesh, isTextured(mesh) ? textureNode(pictureName(mesh, name)) : "");
  return out.finish();
}

}  // namespace

std::string textureNode(const std::string& picture) {
  return fmt::format("Texture2 {{ filename \"{}\" }}", picture);
}

void printSeparator(TextSink& out, const Mesh& mesh, const std::string& texture) {
  out.print("Separator {{\n{}", kInventorHints);
  const Feature* colour = findOf(mesh, "colour", 3);
  if (!texture.empty()) {
    out.print("  {}\n", texture);
  } else if (colour) {
    printNode(out, "Material", "diffuseColor", colour->values, 3);
    out.print("  MaterialBinding {{ value PER_VERTEX_INDEXED }}\n");
  }
  if (const Feature* normal = findOf(mesh, "normal", 3)) {
    printNode(out, "Normal", "vector", normal->values, 3);
    out.print("  NormalBinding {{ value PER_VERTEX_INDEXED }}\n");
  }
  if (const Feature* texcoord = findOf(mesh, "texcoord", 2)) {
    printNode(out, "TextureCoordinate2", "point", texcoord->values, 2);
    out.print("  TextureCoordinateBinding {{ value PER_VERTEX_INDEXED }}\n");
  }
  printNode(out, "Coordinate3", "point", mesh.positions, 3);
  out.print("  IndexedFaceSet {{\n    coordIndex [\n");
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    out.print("      {}, {}, {}, -1,\n", mesh.triangles[t], mesh.triangles[t + 1],
              mesh.triangles[t + 2]);
  }
  out.print("    ]\n  }}\n}}\n");
}

const MeshWriter kInventorWriter{"iv", carries, write, PicturePlace::kCompanionFile};

}  // namespace merlin::render::mesh
