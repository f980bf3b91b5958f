// .mrm, the multiresolution model file, version 1: written whole, read by mmap. Format: FORMAT.md.
#pragma once

#include <string>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

// Maps and checks the file: checksums, sizes, and all that Dendrogram::make() checks. O(file), at
// memory speed. Errors, with the file's name and the section: kNotFound, kIo, kMalformed (damaged,
// cut short), kUnsupported (a later version).
Result<Dendrogram> readMrm(const std::string& path);

// The same, but read into memory of our own before it is checked: for who lives long, since another
// program may write over the file at any time, or cut it short (a mapping would change under the
// checks, or end the program with SIGBUS). Takes the file's size of memory. `stamp`, where given:
// of the file that was read. Errors: also kIo where it changed while it was read, or does not fit
// into memory.
Result<Dendrogram> readMrmCopy(const std::string& path, FileStamp* stamp = nullptr);

// Whether its features can be told from one another in a model, which keeps of each name as many
// characters as 31 bytes hold; to be asked before long work. Errors: kUnsupported, without the
// file's name.
Result<Ok> checkNames(const Mesh& mesh);

// Writes atomically; the same dendrogram gives the same bytes. Errors: kNotFound (no such folder),
// kIo.
Result<Ok> writeMrm(const std::string& path, const Dendrogram& dendrogram);

// The same bytes as of buildDendrogram(mesh, log), without making it: beside mesh and log it takes
// no more than DeathOrder does. Same errors; `threads`: 0 for all, the file is the same.
Result<Ok> writeMrm(const std::string& path, const Mesh& mesh, const CollapseLog& log,
                    unsigned threads = 0);

}  // namespace merlin::render
