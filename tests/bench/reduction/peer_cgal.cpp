// CGAL as a peer: edge collapse with the cost of Lindstrom and Turk (CGAL's default) and that of
// Garland and Heckbert, as in CGAL's own examples. Supports manifold meshes only, without colours.
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "tests/bench/reduction/peer.h"

namespace merlin::bench {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

// CGAL's own stop predicates count edges, whereas all programs here stop at the same number of
// triangles.
struct StopAtTriangles {
  std::size_t triangles;
  template <typename Cost, typename Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
    return profile.surface_mesh().number_of_faces() <= triangles;
  }
};

class CgalPeer : public Peer {
 public:
  CgalPeer(Surface surface, bool lindstrom_turk)
      : surface_(std::move(surface)), lindstrom_turk_(lindstrom_turk) {}

  void reduce(std::size_t triangles) override {
    const StopAtTriangles stop{triangles};
    if (lindstrom_turk_) {
      sms::edge_collapse(surface_, stop);
      return;
    }
    using Policies = sms::GarlandHeckbert_plane_policies<Surface, Kernel>;
    const Policies policies(surface_);
    const sms::Bounded_normal_change_placement<Policies::Get_placement> placement(
        policies.get_placement());
    sms::edge_collapse(surface_, stop,
                       CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
  }

  render::mesh::Mesh result() override {
    surface_.collect_garbage();
    render::mesh::Mesh mesh;
    for (const auto v : surface_.vertices()) {
      const auto& p = surface_.point(v);
      for (int k = 0; k < 3; ++k) mesh.positions.push_back(static_cast<float>(p[k]));
    }
    for (const auto f : surface_.faces()) {
      for (const auto v : CGAL::vertices_around_face(surface_.halfedge(f), surface_)) {
        mesh.triangles.push_back(static_cast<std::uint32_t>(v));
      }
    }
    return mesh;
  }

 private:
  Surface surface_;
  bool lindstrom_turk_;
};

Result<std::unique_ptr<Peer>> make(render::mesh::Mesh mesh, const std::string& variant) {
  if (variant != "lt" && variant != "gh") {
    return Error{Errc::kInvalidArgument, variant + ": is not lt or gh"};
  }
  std::vector<std::array<std::size_t, 3>> triangles(mesh.triangleCount());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) triangles[t][k] = mesh.triangles[3 * t + k];
  }
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) {
    return Error{Errc::kUnsupported, "not an oriented manifold"};
  }
  std::vector<Kernel::Point_3> points(mesh.vertexCount());
  for (std::size_t v = 0; v < points.size(); ++v) {
    const float* p = &mesh.positions[3 * v];
    points[v] = {p[0], p[1], p[2]};
  }
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return std::unique_ptr<Peer>(new CgalPeer(std::move(surface), variant == "lt"));
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  return merlin::bench::runPeer(argc, argv, "CGAL " CGAL_VERSION_STR, merlin::bench::make);
}
