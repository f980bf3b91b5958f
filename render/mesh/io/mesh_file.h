// Reads and writes mesh files; the file name's ending selects the format.
//
//   read     .ply   ASCII and binary, both byte orders; every scalar vertex property becomes a
//                   feature; the texture image that a comment "TextureFile" names
//            .obj   colours of the vertices, or where they have none, those of the texture images
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
//            Coordinates that lie at an origin are doubles in .ply, decimals in .obj, and the
//            translation of the node in .glb and .gltf; those of .iv and .stl are floats.
//            .glb and .gltf contain the texture image. For .ply, .obj and .iv it is a companion
//            file in the same folder: for a.obj, a.obj.png (or .jpg) and a.obj.mtl. Unusual
//            characters of the name are escaped (plainName() in companion_files.h).
//
// Coordinates of a .ply whose x, y or z is a double, of an .obj and of an .off are kept relative to
// originNear() of the first vertex, which a note says; LoadedMesh::origin is what was subtracted.
// Of other files, whose coordinates are read as floats, a note says if these are coarse for the
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
  Origin origin{};                 // of the file's coordinates; positions are relative to it
  // Colours of the triangles, triangles x 3, each 0..1, if the file gives colours to facets and not
  // to vertices. The functions below turn them into colours of vertices and return this empty.
  std::vector<float> facet_colours{};
};

// Size of a mesh in a file.
struct MeshFileSize {
  MeshSize mesh;                        // normals are not counted
  std::size_t meanwhile = 0;            // that reading takes besides [bytes], without the images
  std::vector<std::string> pictures{};  // paths of the texture images; each once
};

// How large the mesh in the file is, before any of it is kept: of .ply and .off as the header
// declares it, and where faces of .ply may have more than three corners, as the file's size allows;
// of .obj and ASCII .stl as their lines are counted. Nothing if the file cannot be opened, is
// damaged, or declares more elements than the file has bytes. Reads the header only, or all lines.
std::optional<MeshFileSize> meshFileSize(const std::string& path);

// File endings that readMesh() supports, for messages and help: ".ply, .obj and .stl".
std::string readableEndings();

// Whether readMesh() supports the ending.
bool isReadable(const std::string& path);

// Whether the file begins as one of these formats does, whatever its name. False if it cannot be
// opened. Reads its beginning only.
bool isMeshFile(const std::string& path);

// As readMesh(), by the file's content; its name's ending counts where the content tells nothing.
Result<LoadedMesh> readMeshByContent(const std::string& path);

// Errors, each with the file's name and the place in it: kNotFound, kIo, kMalformed (truncated,
// damaged, no triangles), kUnsupported (an unknown ending, an unsupported variant of a format).
Result<LoadedMesh> readMesh(const std::string& path);

// What writeMesh() has written, and what the format could not hold.
struct WrittenMesh {
  std::string format;                   // the ending, in lower case
  std::vector<std::string> left_out;    // names of features; "the texture image"
  std::vector<std::string> companions;  // paths of the companion files
  // What is missing from the file's coordinates: the origin, if the format's numbers are floats,
  // which would round it; else 0 0 0.
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
