// A peer program in the reduction benchmark: PROGRAM VARIANT IN.ply TRIANGLES OUT.ply reads the
// mesh, reduces it to at most TRIANGLES triangles, writes the result and prints one line of JSON.
//
// Only reduce() is measured. The peer's own data structure is built before the measurement and
// counts as the loaded mesh, so neither the time to build it nor its size counts against the peer.
#pragma once

#include <memory>
#include <string>

#include "render/mesh/mesh.h"

namespace merlin::bench {

class Peer {
 public:
  virtual ~Peer() = default;
  virtual void reduce(std::size_t triangles) = 0;
  virtual render::mesh::Mesh result() = 0;  // with a feature "colour" if the peer preserves it
};

// Makes a peer for a mesh with or without a feature "colour". Errors: kInvalidArgument if the
// variant is unknown; kUnsupported, with the reason, if the peer cannot process this mesh.
using MakePeer = Result<std::unique_ptr<Peer>> (*)(render::mesh::Mesh mesh,
                                                   const std::string& variant);

// Does everything that main() has to do. `version` is the peer's name as printed. The exit status
// is 0 also if the peer cannot process the mesh; the line is then {"skipped": "why"}.
int runPeer(int argc, char** argv, const char* version, MakePeer make);

}  // namespace merlin::bench
