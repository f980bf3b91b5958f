// Paths and names of companion files: files that a mesh file refers to and that lie in its folder
// or below (materials, texture images).
#pragma once

#include <string>
#include <string_view>

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

}  // namespace merlin::render::mesh
