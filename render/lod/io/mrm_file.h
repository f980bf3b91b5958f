// Reads and writes .mrm files, the format of multiresolution models, version 1. Files are written
// atomically and read by mmap. Format: FORMAT.md.
#pragma once

#include <string>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::lod {

// Maps a file and checks it: checksums, sizes, and everything that Dendrogram::make() checks.
// O(file), at memory speed. Errors, with the file's name and the section: kNotFound, kIo,
// kMalformed (damaged, truncated), kUnsupported (another version, an unknown section).
Result<Dendrogram> readMrm(const std::string& path);

// Does what readMrm() does, but first copies the file into memory. For long-lived processes:
// another program may overwrite or truncate the file at any time, and a mapping would then change
// after the checks, or end the process with SIGBUS. Needs memory of the size of the file. `stamp`,
// if not null, receives the FileStamp of the file that was read. Errors: also kIo if the file
// changed while it was read, or does not fit into memory.
Result<Dendrogram> readMrmCopy(const std::string& path, FileStamp* stamp = nullptr);
// Does the same for an open file descriptor. `path` is used only in messages.
Result<Dendrogram> readMrmCopy(int fd, const std::string& path, FileStamp* stamp = nullptr);

// Checks that the names of features stay different in an .mrm file, which keeps only the complete
// characters within the first 31 bytes of a name; call it before long work. Errors: kUnsupported,
// without the file's name.
Result<Ok> checkNames(const mesh::Mesh& mesh);

// Writes a model file atomically; the same dendrogram gives the same bytes. Errors: kNotFound (no
// such folder), kIo.
Result<Ok> writeMrm(const std::string& path, const Dendrogram& dendrogram);

// Writes the same bytes as writeMrm(path, buildDendrogram(mesh, log)), without building the
// dendrogram: apart from mesh and log it needs little more memory than RemovalOrder. `threads`: 0
// for all cores; the file does not depend on the number. Errors: as for the other writeMrm().
Result<Ok> writeMrm(const std::string& path, const mesh::Mesh& mesh, const CollapseLog& log,
                    unsigned threads = 0);

}  // namespace merlin::render::lod
