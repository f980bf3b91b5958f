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
// originNear() of the first vertex. LoadedMesh::origin is what was subtracted, and a note says so.
// The coordinates of other files are read as floats; a note warns if floats are too coarse for the
// mesh's size.
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
  std::vector<std::string> notes;  // for the user: data left out, a missing texture image
  Origin origin{};                 // what was subtracted from the file's coordinates
  // Colours of the triangles, triangles x 3, each 0..1, if the file gives colours to facets and not
  // to vertices. Set only by a format's parser: the functions below convert these colours to
  // colours of vertices and return this vector empty.
  std::vector<float> facet_colours{};
};

// Size of a mesh in a file.
struct MeshFileSize {
  MeshSize mesh;                        // normals are not counted
  std::size_t meanwhile = 0;            // temporary memory of reading [bytes], without the images
  std::vector<std::string> pictures{};  // paths of the texture images, each once
};

// Returns how large the mesh in the file is, without loading it. For .ply and .off it is what the
// header declares; if faces of a .ply may have more than three corners, it is the most that fits
// into the file's size. For .obj and ASCII .stl the lines are counted. Nothing if the file cannot
// be opened, is damaged, or declares more elements than it has bytes. Reads only the header, or all
// lines.
std::optional<MeshFileSize> meshFileSize(const std::string& path);

// File endings that readMesh() supports, for messages and help: ".ply, .obj and .stl".
std::string readableEndings();

// Whether readMesh() supports the ending.
bool isReadable(const std::string& path);

// Whether the file's content begins like one of these formats, whatever its name. False if it
// cannot be opened. Reads only its beginning.
bool isMeshFile(const std::string& path);

// As readMesh(), but selects the format by the file's content; the name's ending is used only if
// the content does not show the format.
Result<LoadedMesh> readMeshByContent(const std::string& path);

// Errors, each with the file's name and the place in it: kNotFound, kIo, kMalformed (truncated,
// damaged, no triangles), kUnsupported (an unknown ending, an unsupported variant of a format).
Result<LoadedMesh> readMesh(const std::string& path);

// What writeMesh() has written, and what the format could not hold.
struct WrittenMesh {
  std::string format;                   // the ending, in lower case
  std::vector<std::string> left_out;    // names of features; "the texture image"
  std::vector<std::string> companions;  // paths of the companion files
  // The offset that is missing from the file's coordinates: the origin, if the format holds only
  // floats, which would round the sums; else 0 0 0.
  Origin relative_to{};
};

// Checks that writeMesh() supports the ending; call it before long work. Errors: kUnsupported.
Result<Ok> checkMeshEnding(const std::string& path);

// Checks that no companion file of writeMesh(path, mesh) has the name of a different existing file;
// call it before long work. `mesh` may be any mesh with texture coordinates and the same texture
// image. Errors: kInvalidArgument.
Result<Ok> checkCompanions(const std::string& path, const Mesh& mesh);

// Writes the mesh file and its companion files: all of them completely, or none. `origin` is added
// to the positions, as doubles, where the format can hold the sums; readMesh() finds the mesh at
// the same place. Errors: kIo, kNotFound, kUnsupported (an unknown ending; a mesh too large for the
// format, or without triangles), kInvalidArgument (a companion file exists with different content).
// REQUIRES: validate(mesh), finite numbers in `origin`.
Result<WrittenMesh> writeMesh(const std::string& path, const Mesh& mesh, const Origin& origin = {});

}  // namespace merlin::render::mesh
