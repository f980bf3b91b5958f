#include "render/mesh/io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/mesh/io/openmesh_reader.h"
#include "render/mesh/io/ply.h"

namespace merlin::render {
namespace {

// "ply" of "a/b.PLY"; empty where the name has no ending.
std::string ending(const std::string& path) {
  const auto dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] != '.') return {};
  std::string end = path.substr(dot + 1);
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end;
}

Error inFile(const std::string& path, const Error& error) {
  return {error.code, path + ": " + error.what};
}

}  // namespace

Result<LoadedMesh> readMesh(const std::string& path) {
  const std::string end = ending(path);
  if (end != "ply" && end != "obj") {
    return Error{Errc::kUnsupported, fmt::format("{}: meshes are read from .ply and .obj", path)};
  }
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  auto loaded = end == "ply" ? ply::parse(file->text()) : readWithOpenMesh(file->text());
  if (!loaded) return inFile(path, loaded.error());
  if (const auto valid = validate(loaded->mesh); !valid) return inFile(path, valid.error());
  const TidyReport tidied = tidy(loaded->mesh);
  loaded->tidied.degenerate += tidied.degenerate;
  loaded->tidied.unused += tidied.unused;
  if (loaded->mesh.triangles.empty()) {
    return Error{Errc::kMalformed, path + ": has no triangles"};
  }
  return loaded;
}

Result<Ok> writeMesh(const std::string& path, const Mesh& mesh) {
  if (ending(path) != "ply") {
    return Error{Errc::kUnsupported, fmt::format("{}: meshes are written as .ply", path)};
  }
  return writeFile(path, [&](const WriteBytes& write) { return ply::write(mesh, write); });
}

}  // namespace merlin::render
