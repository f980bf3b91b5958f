// One hostile mesh through everything that a mesh goes through, and what came of many.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace merlin::bench {

struct MeshFuzz {
  std::map<std::string, std::uint64_t> counts;  // of each refusal and repair, by name
  std::string fault;                            // of the last mesh; empty: none

  // validate, tidy, splitNonManifold, reduce with each cost, the dendrogram, cuts. False at a
  // fault.
  bool run(std::uint64_t seed);
};

// The common part of faults and refusals, without names and figures.
std::string kindOf(const std::string& what);

}  // namespace merlin::bench
