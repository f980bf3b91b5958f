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

// Maximum size of all files of a report together, before compression.
inline constexpr std::size_t kMostReportBytes = 32u << 20;

struct CollectedPart {
  // Name and description: "status", "state of both roles, as by merlin status --json".
  std::string name, about;
  PartResult result;
};

// Replaces the secrets in the files (except pictures), file names and sentences of all parts. Then
// removes each file that does not fit into `most_bytes` together with the files before it, and adds
// a sentence about it to `missing` of its part.
void makeFit(std::vector<CollectedPart>& parts, const KnownSecrets& secrets,
             std::size_t most_bytes = kMostReportBytes);

// Returns the README.txt of the report: its contents, what is missing and why, and what was left
// out on purpose. `made`: date and time of the report, as text.
std::string readmeText(std::span<const CollectedPart> parts, const std::string& made);

// Returns the list of parts as JSON, for programs. `archive`, `bytes`: name and size of the
// archive.
std::string partsJson(std::span<const CollectedPart> parts, const std::string& archive,
                      std::size_t bytes);

// Returns all files of the report, `readme` first as README.txt, in the folder `folder` of the
// archive.
std::vector<PackedFile> packedFiles(const std::vector<CollectedPart>& parts,
                                    const std::string& folder, const std::string& readme);

}  // namespace merlin::cli
