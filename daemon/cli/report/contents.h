// The contents of a report: its files, without secrets and within a size limit, and the text that
// explains them. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "daemon/cli/report/known_secrets.h"
#include "daemon/cli/report/part.h"

namespace merlin::cli {

inline constexpr std::size_t kMostReportBytes = 32u << 20;  // of all files, before compression

struct CollectedPart {
  std::string name, about;  // "status"; "state of both roles, as by merlin status --json"
  PartResult result;
};

// Removes the secrets from the parts' files and sentences; pictures are not changed. Removes the
// files that do not fit into `most_bytes` after the files before them; a sentence about each is
// added to what is missing.
void makeFit(std::vector<CollectedPart>& parts, const KnownSecrets& secrets,
             std::size_t most_bytes = kMostReportBytes);

// The report's README.txt: what is in it, what is missing and why, and what was left out on
// purpose. `made`: time of the report, as text.
std::string readmeText(std::span<const CollectedPart> parts, const std::string& made);

// The list of parts as JSON, for programs: `bytes` is the size of the archive.
std::string partsJson(std::span<const CollectedPart> parts, const std::string& archive,
                      std::size_t bytes);

// All files, README.txt first, placed in a folder with this name in the archive.
std::vector<PackedFile> packedFiles(const std::vector<CollectedPart>& parts,
                                    const std::string& folder, const std::string& readme);

}  // namespace merlin::cli
