// Converts texture coordinates and materials of an OBJ file's face corners to vertex features.
// Private to render/mesh/io.
#pragma once

#include "render/mesh/atlas/join_textures.h"
#include "render/mesh/io/obj/obj.h"
#include "render/mesh/io/obj/obj_materials.h"

namespace merlin::render::mesh {

struct TexturedSurface {
  Mesh mesh;
  JoinedTextures joined;
};

// Splits each vertex of the file into one vertex for each combination of texture coordinate and
// material at its corners; the vertices at a seam have bit-identical positions
// (coincidentVertices() finds them). The mesh gets "texcoord" and "colour" if the file has them;
// the colour of a vertex is taken from the vertex in the file, else from the texture image, else
// from the material, else it is white. joinTextures() joins the texture images into one. REQUIRES:
// every index is in range; `materials` has one entry for each of surface.materials.
TexturedSurface textured(ObjSurface surface, const std::vector<ObjMaterial>& materials);

}  // namespace merlin::render::mesh
