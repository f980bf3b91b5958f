// Companion files: files that a mesh file refers to and that lie in its folder or below (materials,
// texture images). Their paths and names, and how they are written.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// The folder part of `path`, with its trailing slash; empty if `path` has no slash.
std::string folderOf(const std::string& path);

// Path of the companion file that a mesh file in `folder` calls `name`. Names may come from another
// machine or be hostile: if `name` is absolute or could leave the folder ("..", ":"), only its last
// component is used.
std::string pathBeside(const std::string& folder, std::string_view name);

// Name prefix of the companion files of `path`: its file name, in which each byte that could end a
// name in the file that refers to it (a blank, a quote, ...) becomes "=" and two hexadecimal
// digits, e.g. "=20". Different names stay different.
std::string plainName(const std::string& path);

struct CompanionFile {
  std::string name;  // by which the mesh file refers to it
  std::string path, content;
};

// The texture image of a mesh that is written to `path`, if it has one and texture coordinates.
std::optional<CompanionFile> pictureBeside(const Mesh& mesh, const std::string& path);

// Whether the companion file exists already, with the same content. Its name was not given by the
// user, so a file with different content is not overwritten. Errors: kInvalidArgument (different
// content).
Result<bool> isThere(const CompanionFile& file);

// Writes the files that are not there yet, then calls `write`; if anything fails, the files that
// were written are removed again. Errors: those of isThere(), writeFile() and `write`.
Result<Ok> writeBeside(std::span<const CompanionFile> files,
                       const std::function<Result<Ok>()>& write);

}  // namespace merlin::render::mesh
