// Mesh files: reading and writing, by the name's ending.
//
//   read     .ply   ascii and binary of both byte orders; every scalar vertex property becomes a
//                   feature; the picture that a comment "TextureFile" names
//            .obj   colours; texture coordinates, and the colours of the pictures (PNG, JPEG) that
//                   its materials name
//            .off   in plain letters: normals, colours, texture coordinates
//            .om, .stl   through OpenMesh: normals, colours, texture coordinates; faces that
//                   OpenMesh's own meshes cannot hold are kept
//   written  .ply   binary little-endian, every feature: normal as nx ny nz, colour as red green
//                   blue (bytes), label as int, any other as float properties
//            .obj   normal, colour, texcoord
//            .glb, .gltf   normal, colour, texcoord, any other feature of 1 to 4 dimensions
//            .iv    Open Inventor 2.1 ascii: normal, colour, texcoord
//            .stl   binary: triangles alone
//            A texture's picture is inside .glb and .gltf, and beside .ply, .obj and .iv: of
//            a.obj they are a.obj.png (or .jpg) and a.obj.mtl, in plain letters (beside.h).
//
// A mesh that is returned has passed validate(), tidy() and splitNonManifold(). Nothing throws,
// nothing is printed. Reentrant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"
#include "render/mesh/mesh_size.h"
#include "render/mesh/non_manifold.h"

namespace merlin::render {

struct LoadedMesh {
  Mesh mesh;
  TidyReport tidied;
  SplitReport split;
  std::vector<std::string> notes;  // for a person: what is left out, a picture that is not there
};

// Size of a mesh in a file.
struct MeshFileSize {
  MeshSize mesh;        // features without normals
  std::string picture;  // path of the texture's picture; empty: none
};

// Size of the mesh by the file's header; nothing if the file cannot be opened, its format does not
// say, or it claims more than its bytes can hold. Reads the header only.
std::optional<MeshFileSize> meshFileSize(const std::string& path);

// The endings that are read, for messages and help: ".ply, .obj and .stl".
std::string readableEndings();

// Errors, each with the file's name and where in it: kNotFound, kIo, kMalformed (cut short, broken,
// no triangles), kUnsupported (an ending or a variant that is not read).
Result<LoadedMesh> readMesh(const std::string& path);

// Report of what a file could not hold.
struct WrittenMesh {
  std::string format;                 // the ending, in small letters
  std::vector<std::string> left_out;  // features, by name; the texture's picture
  std::vector<std::string> beside;    // files that it names, with the same folder
};

// Whether writeMesh() knows the ending; to be asked before long work. Errors: kUnsupported.
Result<Ok> checkMeshEnding(const std::string& path);

// Whether writeMesh() would find another file where it puts one beside the mesh's; to be asked
// before long work, with any mesh of that picture. Errors: kInvalidArgument.
Result<Ok> checkBeside(const std::string& path, const Mesh& mesh);

// The file appears whole or not at all, and with it those that it names. Errors: kIo, kNotFound,
// kUnsupported (another ending; a mesh too large for the format, or without triangles),
// kInvalidArgument (a file beside it is there already, and is another).
// REQUIRES: validate(mesh).
Result<WrittenMesh> writeMesh(const std::string& path, const Mesh& mesh);

}  // namespace merlin::render
