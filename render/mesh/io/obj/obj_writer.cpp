// Writes Wavefront OBJ. Colours follow the position in each v line, as MeshLab, Blender and
// OpenMesh read them.
#include "render/mesh/io/text_sink.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

bool carries(const Mesh&, const Feature& f) { return isUsual(f); }

std::string material(const Mesh& mesh, const std::string& name) {
  return "# written by MERLIN\nnewmtl textured\nKd 1 1 1\nmap_Kd " + pictureName(mesh, name) + "\n";
}

// Prints a position with the fewest digits that reproduce the same double, or the same float if
// there is no origin.
void printPosition(TextSink& out, const float* p, const Origin& origin) {
  if (origin == Origin{})
    out.print("v {} {} {}", p[0], p[1], p[2]);
  else
    out.print("v {} {} {}", p[0] + origin[0], p[1] + origin[1], p[2] + origin[2]);
}

bool write(const Mesh& mesh, const Origin& origin, const std::string& name,
           const WriteBytes& bytes) {
  const Feature* normal = findOf(mesh, "normal", 3);
  const Feature* colour = findOf(mesh, "colour", 3);
  const Feature* texcoord = findOf(mesh, "texcoord", 2);
  TextSink out(bytes);
  out.print("# written by MERLIN\n");
  if (isTextured(mesh)) out.print("mtllib {}.mtl\nusemtl textured\n", name);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    printPosition(out, &mesh.positions[3 * v], origin);
    if (colour) {
      const float* c = &colour->values[3 * v];
      out.print(" {} {} {}", c[0], c[1], c[2]);
    }
    out.print("\n");
  }
  if (texcoord) out.printRows(texcoord->values, 2, "vt ", "\n");
  if (normal) out.printRows(normal->values, 3, "vn ", "\n");
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    out.print("f");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t v = std::uint64_t{mesh.triangles[t + k]} + 1;
      if (texcoord && normal)
        out.print(" {0}/{0}/{0}", v);
      else if (texcoord)
        out.print(" {0}/{0}", v);
      else if (normal)
        out.print(" {0}//{0}", v);
      else
        out.print(" {}", v);
    }
    out.print("\n");
  }
  return out.finish();
}

}  // namespace

const MeshWriter kObjWriter{"obj", carries, write,   PicturePlace::kCompanionFile,
                            true,  nullptr, material};

}  // namespace merlin::render::mesh
