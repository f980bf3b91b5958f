// Runs a hostile mesh through all steps of mesh processing, and counts the outcomes.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace merlin::bench {

struct MeshFuzz {
  // Number of each kind of refusal and repair, by name.
  std::map<std::string, std::uint64_t> counts;
  std::string fault;  // of the last mesh; empty if there was no fault

  // Makes the mesh for this seed and runs validate, tidy, splitNonManifold, reduce with each cost,
  // the dendrogram and cuts. Returns false if there was a fault.
  bool run(std::uint64_t seed);
};

// Returns the part of a message that all faults or refusals of its kind share, without names and
// figures.
std::string kindOf(const std::string& what);

}  // namespace merlin::bench
