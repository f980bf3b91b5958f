// Texture coordinates and colours of an OBJ file's corners as features of vertices. Private to
// render/mesh/io.
#pragma once

#include "render/mesh/io/obj/obj.h"
#include "render/mesh/io/obj/obj_materials.h"

namespace merlin::render {

// One vertex for each texture coordinate and material that a vertex of the file has at its corners:
// at a seam several in one place, bit by bit (samePlace() finds them). The mesh gets "texcoord" and
// "colour" where the file has them: of a corner the picture's colour, else the vertex' own, else
// the material's, else white. Where one picture that repeats is at every corner, it is the mesh's
// texture as well.
// REQUIRES: every index in range, `materials` are the surface's.
Mesh textured(ObjSurface surface, const std::vector<ObjMaterial>& materials);

}  // namespace merlin::render
