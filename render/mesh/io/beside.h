// Files that lie beside a mesh's and that it names: materials, pictures.
#pragma once

#include <string>
#include <string_view>

namespace merlin::render {

// With its slash; empty where there is none.
std::string folderOf(const std::string& path);

// Where `name` is, as a mesh in `folder` has it. A model that was sent from elsewhere names paths
// of there, and may name anything: what would leave the folder is looked for in it.
std::string pathBeside(const std::string& folder, std::string_view name);

// Prefix of the names of files beside `path`: its own name, in which bytes that a file that names
// them might take for the end of a name become "=20". Different names stay different.
std::string plainName(const std::string& path);

}  // namespace merlin::render
