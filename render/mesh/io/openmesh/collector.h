// Collector: an OpenMesh importer that stores vertices and faces exactly as a file has them.
// Private to render/mesh/io.
//
// OpenMesh's own meshes silently drop faces that half-edges cannot represent (a third face at an
// edge). A Collector keeps every face, and rejects indices that are out of range.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

// Exception that a Collector throws into OpenMesh's reader; openmesh_reader.cpp catches it.
class BrokenFile : public std::runtime_error {
  using runtime_error::runtime_error;
};

class Collector final : public OpenMesh::IO::BaseImporter {
 public:
  using VertexHandle = OpenMesh::VertexHandle;
  using HalfedgeHandle = OpenMesh::HalfedgeHandle;
  using EdgeHandle = OpenMesh::EdgeHandle;
  using FaceHandle = OpenMesh::FaceHandle;
  using Status = OpenMesh::Attributes::StatusInfo;

  // `most`: upper limit for each of the numbers of vertices, faces, corners and half-edges, so that
  // a damaged file cannot allocate more than it can hold.
  explicit Collector(std::size_t most) : most_(most) {}

  // Returns the collected mesh, with polygons as triangle fans. Throws BrokenFile if the half-edges
  // of a face do not form a loop.
  Mesh take();
  std::size_t vertices() const noexcept { return positions_.size() / 3; }
  std::size_t faces() const noexcept { return face_begin_.size() + face_halfedge_.size(); }

  VertexHandle add_vertex(const OpenMesh::Vec3f& p) override;
  VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3f(0, 0, 0)); }
  void set_point(VertexHandle v, const OpenMesh::Vec3f& p) override;
  FaceHandle add_face(const VHandles& corners) override;

  // The next three functions receive half-edges, numbered as in an OM file: edge e has the
  // half-edges 2 e and 2 e + 1.
  HalfedgeHandle add_edge(VertexHandle from, VertexHandle to) override;
  FaceHandle add_face(HalfedgeHandle h) override;
  void set_next(HalfedgeHandle h, HalfedgeHandle next) override;
  void set_face(HalfedgeHandle, FaceHandle) override {}
  void set_halfedge(VertexHandle, HalfedgeHandle) override {}

  void set_normal(VertexHandle v, const OpenMesh::Vec3f& n) override { set(normal_, v, n, 1); }
  void set_normal(VertexHandle v, const OpenMesh::Vec3d& n) override {
    set(normal_, v, OpenMesh::Vec3f(n), 1);
  }
  void set_color(VertexHandle v, const OpenMesh::Vec3uc& c) override { set(colour_, v, c, 255); }
  void set_color(VertexHandle v, const OpenMesh::Vec4uc& c) override { set(colour_, v, c, 255); }
  void set_color(VertexHandle v, const OpenMesh::Vec3f& c) override { set(colour_, v, c, 1); }
  void set_color(VertexHandle v, const OpenMesh::Vec4f& c) override { set(colour_, v, c, 1); }
  void set_texcoord(VertexHandle v, const OpenMesh::Vec2f& t) override { set(texcoord_, v, t, 1); }
  void set_texcoord(VertexHandle v, const OpenMesh::Vec3f& t) override { set(texcoord_, v, t, 1); }

  // The following are ignored: status flags, and properties of faces, edges and half-edges.
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(FaceHandle, int) override {}
  void set_status(VertexHandle, const Status&) override {}
  void set_status(HalfedgeHandle, const Status&) override {}
  void set_status(EdgeHandle, const Status&) override {}
  void set_status(FaceHandle, const Status&) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec4f&) override {}
  void add_texture_information(int, std::string) override {}

  // OpenMesh looks up an OM file's custom properties in this mesh. The mesh has none, so OpenMesh
  // skips them.
  OpenMesh::BaseKernel* kernel() override { return &empty_; }
  std::size_t n_vertices() const override { return vertices(); }
  std::size_t n_faces() const override { return faces(); }
  std::size_t n_edges() const override { return to_.size() / 2; }

 private:
  std::uint32_t checked(VertexHandle v) const;
  std::uint32_t checked(HalfedgeHandle h) const;
  void addLoops();
  // Values of a feature, up to the last vertex that was set; take() appends zeros for the remaining
  // vertices.
  struct Values {
    std::size_t dimension;
    std::vector<float> values;
  };
  template <typename Vector>
  void set(Values& to, VertexHandle v, const Vector& from, float full) {
    const std::size_t at = std::size_t{checked(v)} * to.dimension;
    if (to.values.size() < at + to.dimension) to.values.resize(at + to.dimension);
    for (std::size_t k = 0; k < to.dimension; ++k)
      to.values[at + k] = static_cast<float>(from[static_cast<unsigned>(k)]) / full;
  }

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::size_t most_;
  std::vector<float> positions_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::size_t> face_begin_;  // by face: index of its first corner in corners_
  std::vector<std::uint32_t> to_, next_, face_halfedge_;
  Values normal_{3, {}}, colour_{3, {}}, texcoord_{2, {}};
  OpenMesh::PolyMesh_ArrayKernelT<> empty_;
};

}  // namespace merlin::render::mesh
