#include "tests/bench/reduction/peer.h"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "render/mesh/io/mesh_file.h"
#include "tests/bench/reduction/measure.h"

namespace merlin::bench {
namespace {

int fail(const std::string& what) {
  fmt::print(stderr, "{}\n", what);
  return 1;
}

int skip(const std::string& why) {
  fmt::print("{{\"skipped\": \"{}\"}}\n", why);
  return 0;
}

int run(char** argv, const char* version, MakePeer make) {
  auto loaded = render::mesh::readMesh(argv[2]);
  if (!loaded) return fail(loaded.error().what);
  const std::size_t vertices = loaded->mesh.vertexCount();
  const std::size_t triangles = std::stoul(argv[3]);
  auto peer = make(std::move(loaded->mesh), argv[1]);
  if (!peer && peer.error().code == Errc::kUnsupported) return skip(peer.error().what);
  if (!peer) return fail(peer.error().what);

  const Cost cost = measure([&] { (*peer)->reduce(triangles); });

  render::mesh::Mesh left = (*peer)->result();
  render::mesh::tidy(left);
  if (left.triangleCount() == 0) return skip("left no triangle");
  if (const auto written = render::mesh::writeMesh(argv[4], left); !written) {
    return fail(written.error().what);
  }
  fmt::print("{{\"version\": \"{}\", {}, \"triangles\": {}, \"collapses\": {}}}\n", version,
             json(cost), left.triangleCount(), vertices - left.vertexCount());
  return 0;
}

}  // namespace

int runPeer(int argc, char** argv, const char* version, MakePeer make) {
  if (argc != 5) return fail(fmt::format("usage: {} VARIANT IN.ply TRIANGLES OUT.ply", argv[0]));
  try {
    return run(argv, version, make);
  } catch (const std::exception& error) {  // any exception that a peer throws
    return skip(fmt::format("threw: {}", error.what()));
  }
}

}  // namespace merlin::bench
