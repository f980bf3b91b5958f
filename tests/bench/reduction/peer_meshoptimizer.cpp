// meshoptimizer as a peer: plain simplify, which keeps a subset of the vertices. From version 1 on
// also the attribute mode, which moves vertices and fits their colours anew.
#include <limits>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "tests/bench/reduction/peer.h"

namespace merlin::bench {
namespace {

using render::mesh::Mesh;

constexpr float kNoErrorLimit = std::numeric_limits<float>::max();

class Plain : public Peer {
 public:
  explicit Plain(Mesh mesh) : mesh_(std::move(mesh)), left_(mesh_.triangles.size()) {}

  void reduce(std::size_t triangles) override {
    left_.resize(meshopt_simplify(left_.data(), mesh_.triangles.data(), mesh_.triangles.size(),
                                  mesh_.positions.data(), mesh_.vertexCount(), 3 * sizeof(float),
                                  3 * triangles, kNoErrorLimit, 0, nullptr));
  }

  Mesh result() override {
    mesh_.triangles = left_;
    return mesh_;
  }

 private:
  Mesh mesh_;
  std::vector<unsigned> left_;
};

#if MESHOPTIMIZER_VERSION >= 1000
class WithColour : public Peer {
 public:
  explicit WithColour(Mesh mesh) : mesh_(std::move(mesh)) {}

  void reduce(std::size_t triangles) override {
    // the best of the weights that were tried on range images
    const float weights[] = {0.5F, 0.5F, 0.5F};
    auto& colours = mesh_.find("colour")->values;
    mesh_.triangles.resize(meshopt_simplifyWithUpdate(
        mesh_.triangles.data(), mesh_.triangles.size(), mesh_.positions.data(), mesh_.vertexCount(),
        3 * sizeof(float), colours.data(), 3 * sizeof(float), weights, 3, nullptr, 3 * triangles,
        kNoErrorLimit, 0, nullptr));
  }

  Mesh result() override { return mesh_; }

 private:
  Mesh mesh_;
};
#endif

Result<std::unique_ptr<Peer>> make(Mesh mesh, const std::string& variant) {
  if (variant == "plain") return std::unique_ptr<Peer>(new Plain(std::move(mesh)));
#if MESHOPTIMIZER_VERSION >= 1000
  if (!mesh.find("colour")) return Error{Errc::kUnsupported, "the mesh has no colours"};
  if (variant == "colour") return std::unique_ptr<Peer>(new WithColour(std::move(mesh)));
#else
  if (variant == "colour") {
    return Error{Errc::kUnsupported, "this version has no attribute mode (it came with version 1)"};
  }
#endif
  return Error{Errc::kInvalidArgument, variant + ": is not plain or colour"};
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  const std::string version = fmt::format("meshoptimizer {}.{}", MESHOPTIMIZER_VERSION / 1000,
                                          MESHOPTIMIZER_VERSION % 1000 / 10);
  return merlin::bench::runPeer(argc, argv, version.c_str(), merlin::bench::make);
}
