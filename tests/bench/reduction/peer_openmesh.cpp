// OpenMesh as a peer: its decimater with the quadric module only. It collapses half-edges, so the
// result has a subset of the vertices with their colours.
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/config.h>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <fmt/format.h>

#include "tests/bench/reduction/peer.h"

namespace merlin::bench {
namespace {

using Surface = OpenMesh::TriMesh_ArrayKernelT<>;
using Decimater = OpenMesh::Decimater::DecimaterT<Surface>;
using Quadric = OpenMesh::Decimater::ModQuadricT<Surface>;

class OpenMeshPeer : public Peer {
 public:
  explicit OpenMeshPeer(render::mesh::Mesh mesh) : mesh_(std::move(mesh)) {
    surface_.request_vertex_status();
    surface_.request_edge_status();
    surface_.request_face_status();
    for (std::size_t v = 0; v < mesh_.vertexCount(); ++v) {
      const float* p = &mesh_.positions[3 * v];
      surface_.add_vertex({p[0], p[1], p[2]});
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += 3) {
      const auto corner = [&](std::size_t k) {
        return Surface::VertexHandle(static_cast<int>(mesh_.triangles[t + k]));
      };
      taken_ += surface_.add_face(corner(0), corner(1), corner(2)).is_valid();
    }
    mesh_.triangles = {};
  }

  std::size_t taken() const { return taken_; }

  void reduce(std::size_t triangles) override {
    Decimater decimater(surface_);
    OpenMesh::Decimater::ModHandleT<Quadric> quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, triangles);
  }

  render::mesh::Mesh result() override {
    for (const auto face : surface_.faces()) {
      if (surface_.status(face).deleted()) continue;
      for (const auto corner : face.vertices()) {
        mesh_.triangles.push_back(static_cast<std::uint32_t>(corner.idx()));
      }
    }
    return mesh_;
  }

 private:
  render::mesh::Mesh mesh_;  // its triangles are in surface_ during the reduction
  Surface surface_;
  std::size_t taken_ = 0;
};

Result<std::unique_ptr<Peer>> make(render::mesh::Mesh mesh, const std::string&) {
  const std::size_t triangles = mesh.triangleCount();
  auto peer = std::make_unique<OpenMeshPeer>(std::move(mesh));
  if (peer->taken() != triangles) {
    return Error{Errc::kUnsupported, fmt::format("not a manifold: {} of {} triangles do not fit in",
                                                 triangles - peer->taken(), triangles)};
  }
  return std::unique_ptr<Peer>(std::move(peer));
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  const std::string version =
      fmt::format("OpenMesh {}.{}", (OM_VERSION & 0xf0000) >> 16, (OM_VERSION & 0x0ff00) >> 8);
  return merlin::bench::runPeer(argc, argv, version.c_str(), merlin::bench::make);
}
