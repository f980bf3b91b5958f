// Companion files: files that a mesh file refers to and that lie in its folder or below (materials,
// texture images). Their paths and names, and how they are written.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// The folder part of `path`, with its trailing slash; empty if `path` has no slash.
std::string folderOf(const std::string& path);

// Path of the companion file that a mesh file in `folder` calls `name`. Names may come from another
// machine or be hostile: if `name` is absolute or could leave the folder ("..", ":"), only its last
// component is used.
std::string pathBeside(const std::string& folder, std::string_view name);

// Finds the companion files that a mesh file in `folder` names, also those whose names differ in
// upper and lower case (of ASCII letters), as names from DOS and Windows may. Thread-bound.
class CompanionFinder {
 public:
  // Lists folders when that is needed, each once.
  explicit CompanionFinder(std::string folder) : folder_(std::move(folder)), lists_(true) {}
  // Takes names from `files` instead, for a process that may not list folders. Paths that do not
  // begin with `folder` are ignored.
  CompanionFinder(std::string folder, const std::vector<std::string>& files);

  // Returns pathBeside() if something is there, else the first path (by its bytes) that differs
  // from it only in case; if there is none, pathBeside() again.
  std::string find(std::string_view name);

  // Says which file was found in place of another name, and how many more; empty if none was.
  std::string note() const;

 private:
  using Names = std::map<std::string, std::string>;  // by the name in lower case
  const Names& namesIn(const std::string& folder);
  std::string inAnyCase(const std::string& path);

  std::string folder_;
  bool lists_;
  std::map<std::string, Names> folders_;      // by path, with a trailing slash
  std::map<std::string, std::string> other_;  // path found, by the path that was named
};

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
