// .mrm, the multiresolution model file, version 1: written whole, read whole. Format: FORMAT.md.
#pragma once

#include <string>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render {

// Reads the file into the dendrogram's own memory and checks that: checksums, sizes, and all that
// Dendrogram::make() checks. Whatever happens to the file afterwards changes nothing. O(file), at
// memory speed. `stamp`, where given: of the file that was read. Errors, with the file's name and
// the section: kNotFound, kIo (also: it changed while it was read, it does not fit into memory),
// kMalformed (damaged, cut short), kUnsupported (a later version).
Result<Dendrogram> readMrm(const std::string& path, FileStamp* stamp = nullptr);

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
