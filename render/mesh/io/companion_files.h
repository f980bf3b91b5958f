// Finds, names and writes companion files: files that a mesh file refers to and that lie in its
// folder or below (materials, texture images).
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

// Returns the folder part of `path`, with its trailing slash; empty if `path` has no slash.
std::string folderOf(const std::string& path);

// Returns the path of the companion file that a mesh file in `folder` calls `name`. Names may come
// from another machine or be hostile: if `name` is absolute or could leave the folder ("..", ":"),
// only its last component is used.
std::string pathBeside(const std::string& folder, std::string_view name);

// Finds the companion files that a mesh file in `folder` refers to, even if a name differs from the
// file's in upper and lower case (of ASCII letters), as names from DOS and Windows may.
// Thread-bound.
class CompanionFinder {
 public:
  // Makes a finder that lists folders on demand, each once.
  explicit CompanionFinder(std::string folder) : folder_(std::move(folder)), lists_(true) {}
  // Makes a finder that uses the paths in `files` instead of listing folders, for a process that
  // may not list them. Paths that do not begin with `folder` are ignored.
  CompanionFinder(std::string folder, const std::vector<std::string>& files);

  // Returns pathBeside(folder, name) if that path exists. Otherwise returns the first path (by its
  // bytes) that differs from it only in case, or pathBeside() again if there is no such path.
  std::string find(std::string_view name);

  // Returns a note for the user that names one file found under a different spelling and the number
  // of other such files; empty if there were none.
  std::string note() const;

 private:
  // Key: the name in lower case; value: the name itself.
  using Names = std::map<std::string, std::string>;
  const Names& namesIn(const std::string& folder);
  std::string inAnyCase(const std::string& path);

  std::string folder_;
  bool lists_;
  // Names in each folder; key: path with a trailing slash.
  std::map<std::string, Names> folders_;
  std::map<std::string, std::string> other_;  // key: path as named in the file; value: path found
};

// Returns the name prefix of the companion files of `path`: its file name, in which each byte that
// could end a name in a mesh file (a blank, a quote, ...) is replaced by "=" and two hexadecimal
// digits, e.g. "=20". Different names stay different.
std::string plainName(const std::string& path);

struct CompanionFile {
  std::string name;  // the name by which the mesh file refers to it
  std::string path, content;
};

// Returns the companion file with the texture image of a mesh that is written to `path`; nothing if
// the mesh lacks a texture image or texture coordinates.
std::optional<CompanionFile> pictureBeside(const Mesh& mesh, const std::string& path);

// Returns whether the companion file exists already with the same content. Errors: kInvalidArgument
// if a file with different content exists: the user did not choose this name, so the file must not
// be overwritten.
Result<bool> isThere(const CompanionFile& file);

// Writes those of `files` that do not exist yet, then calls `write`. If anything fails, the files
// that were written are removed again. Errors: those of isThere(), writeFile() and `write`.
Result<Ok> writeBeside(std::span<const CompanionFile> files,
                       const std::function<Result<Ok>()>& write);

}  // namespace merlin::render::mesh
