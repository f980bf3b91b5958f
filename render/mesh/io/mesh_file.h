// Reads and writes mesh files; the file name's ending selects the format.
//
//   read     .ply   ASCII and binary, both byte orders; every scalar vertex property becomes a
//                   feature; the texture image that a comment "TextureFile" names
//            .obj   colours of the vertices, or if they have none, those of the texture images
//                   (PNG, JPEG) of its materials; texture coordinates
//            .off   ASCII only: normals, colours of vertices or faces, texture coordinates
//            .om, .stl   through OpenMesh: normals, colours, texture coordinates; faces that
//                   OpenMesh's half-edge meshes cannot hold (non-manifold edges) are kept
//   written  .ply   binary little-endian, every feature: normal as nx ny nz, colour as red green
//                   blue (bytes), label as int, any other as float properties
//            .obj   normal, colour, texcoord
//            .glb, .gltf   normal, colour, texcoord, any other feature of 1 to 4 dimensions
//            .iv    Open Inventor 2.1 ASCII: normal, colour, texcoord
//            .stl   binary: triangles only
//            If the mesh has an origin, it is added to the coordinates in .ply (as doubles) and
//            .obj (as decimals), and becomes the translation of the node in .glb and .gltf; .iv
//            and .stl hold floats only, so it is left out.
//            .glb and .gltf contain the texture image. For .ply, .obj and .iv it is a companion
//            file in the same folder: for a.obj, a.obj.png (or .jpg) and a.obj.mtl. Unusual
//            characters of the name are escaped (plainName() in companion_files.h).
//
// The coordinates of an .obj, an .off and a .ply whose x, y or z is a double are kept relative to
// originNear() of the first vertex. LoadedMesh::origin is the offset that was subtracted, and a
// note tells the user. The coordinates of other files are read as floats; a note warns if floats
// are too coarse for the mesh's size.
//
// A returned mesh has passed validate(), tidy() and splitNonManifold(). Nothing throws, nothing is
// printed. Reentrant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/mesh/mesh_size.h"
#include "render/mesh/non_manifold.h"
#include "render/mesh/origin.h"

namespace merlin::render::mesh {

struct LoadedMesh {
  Mesh mesh;
  TidyReport tidied;
  SplitReport split;
  std::vector<std::string> notes;  // notes for the user: data left out, a missing texture image
  Origin origin{};                 // offset that was subtracted from the file's coordinates
  // Colours of the triangles (triangles x 3, each 0..1), if the file gives colours to facets and
  // not to vertices. Only the parser of a format sets this; the functions below convert the colours
  // to colours of vertices and return this vector empty.
  std::vector<float> facet_colours{};
};

// Size of a mesh in a file.
struct MeshFileSize {
  // Size of the mesh; normals are not counted in MeshSize::values.
  MeshSize mesh;
  // Temporary memory while reading, without the images [bytes].
  std::size_t meanwhile = 0;
  std::vector<std::string> pictures{};  // paths of the texture images, each once
};

// Returns the size of the mesh in a file, without loading the mesh. For .ply and .off it is the
// size that the header declares; if faces of a .ply may have more than three corners, it is the
// maximum that fits into the file's size. For .obj and ASCII .stl the lines are counted. Returns
// nothing if the file cannot be opened, is damaged, or declares more elements than it has bytes.
// Reads either only the header, or all lines.
std::optional<MeshFileSize> meshFileSize(const std::string& path);

// Returns the file endings that readMesh() supports, as a list for messages and help: ".ply, .obj
// and .stl".
std::string readableEndings();

// Returns whether readMesh() supports the ending of the path.
bool isReadable(const std::string& path);

// Returns whether the file's content begins like one of these formats, whatever the file's name is.
// Returns false if the file cannot be opened. Reads only the beginning of the file.
bool isMeshFile(const std::string& path);

// Does what readMesh() does, but selects the format by the file's content; the name's ending is
// used only if the content does not show the format.
Result<LoadedMesh> readMeshByContent(const std::string& path);

// Reads a mesh; the ending of the path selects the format. Errors, each with the file's name and
// the place in it: kNotFound, kIo, kMalformed (truncated, damaged, no triangles), kUnsupported (an
// unknown ending, an unsupported variant of a format).
Result<LoadedMesh> readMesh(const std::string& path);

// Reports what writeMesh() has written, and what the format could not hold.
struct WrittenMesh {
  std::string format;                   // ending of the format, in lower case, without the dot
  std::vector<std::string> left_out;    // data not written: names of features, "the texture image"
  std::vector<std::string> companions;  // paths of the companion files
  // The offset that is missing from the file's coordinates: the origin, if the format holds only
  // floats, which would round the sums; else 0 0 0.
  Origin relative_to{};
};

// Checks that writeMesh() supports the ending of `path`; call it before long work. Errors:
// kUnsupported.
Result<Ok> checkMeshEnding(const std::string& path);

// Checks that no companion file of writeMesh(path, mesh) has the name of a different existing file;
// call it before long work. `mesh` may be any mesh with texture coordinates and the same texture
// image. Errors: kInvalidArgument.
Result<Ok> checkCompanions(const std::string& path, const Mesh& mesh);

// Writes the mesh file and its companion files: all of them completely, or none. `origin` is added
// to the positions, as doubles, if the format can hold the sums; readMesh() then returns the mesh
// at the same place. Errors: kIo, kNotFound, kUnsupported (an unknown ending; a mesh too large for
// the format, or without triangles), kInvalidArgument (a companion file exists with different
// content). REQUIRES: validate(mesh), finite numbers in `origin`.
Result<WrittenMesh> writeMesh(const std::string& path, const Mesh& mesh, const Origin& origin = {});

}  // namespace merlin::render::mesh
