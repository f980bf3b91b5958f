// One peer, one process: PROGRAM VARIANT IN.ply TRIANGLES OUT.ply reads the mesh, reduces it to at
// most so many triangles, writes what is left and prints one line of JSON.
//
// Only reduce() is measured. The peer's own structure is built before that and counts as the loaded
// mesh: neither its building nor its size is held against a peer.
#pragma once

#include <memory>
#include <string>

#include "render/mesh/mesh.h"

namespace merlin::bench {

class Peer {
 public:
  virtual ~Peer() = default;
  virtual void reduce(std::size_t triangles) = 0;
  virtual render::Mesh result() = 0;  // with a feature "colour" where the peer carries it along
};

// Takes a mesh with a feature "colour" or none. Errors: kInvalidArgument where there is no such
// variant, kUnsupported where the peer cannot take this mesh, with the reason.
using MakePeer = Result<std::unique_ptr<Peer>> (*)(render::Mesh mesh, const std::string& variant);

// The whole main(). `version` is printed as the peer's name for a person. Exit status 0 also where
// the peer cannot take the mesh: the line then says {"skipped": "why"}.
int runPeer(int argc, char** argv, const char* version, MakePeer make);

}  // namespace merlin::bench
