// Writes files as one compressed archive (.tar.gz), by libarchive.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/base/result.h"

namespace merlin::cli {

struct PackedFile {
  std::string name;     // path in the archive, "report/status.json"
  std::string content;  // any bytes
};

// Writes the archive completely or not at all (writeFile()). `time_s`: time stamp of all files, in
// seconds since 1970. Equal files and times give equal bytes. The archive is readable by its owner
// only; for this, the umask of the process is changed meanwhile. Errors: those of writeFile(); kIo
// (libarchive failed).
Result<Ok> writeTarGz(const std::string& path, std::span<const PackedFile> files,
                      std::int64_t time_s);

}  // namespace merlin::cli
