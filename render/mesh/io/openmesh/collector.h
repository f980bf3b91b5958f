// Collector: takes what OpenMesh's readers find in a file, as it stands there. Private to
// render/mesh/io.
//
// OpenMesh's own meshes drop what their half-edges cannot hold (a third face at an edge) without a
// word. A collector keeps every face, and refuses what points outside of the mesh.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "render/mesh/mesh.h"

namespace merlin::render {

// Thrown through OpenMesh, and caught in openmesh_reader.cpp.
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

  // `most`: of vertices, of faces and of corners, as many as the file can hold.
  explicit Collector(std::size_t most) : most_(most) {}

  // Faces as fans of triangles. Throws BrokenFile where half-edges do not close.
  Mesh take();
  std::size_t vertices() const noexcept { return positions_.size() / 3; }
  std::size_t faces() const noexcept { return face_begin_.size() + face_halfedge_.size(); }

  VertexHandle add_vertex(const OpenMesh::Vec3f& p) override;
  VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3f(0, 0, 0)); }
  void set_point(VertexHandle v, const OpenMesh::Vec3f& p) override;
  FaceHandle add_face(const VHandles& corners) override;

  // Half-edges, as an OM file has them: 2 e and 2 e + 1 are the two of edge e.
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

  // Properties for which a surface of vertices has no place.
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

  // Where OM files' own properties are looked for: none is there, so that they are skipped.
  OpenMesh::BaseKernel* kernel() override { return &empty_; }
  std::size_t n_vertices() const override { return vertices(); }
  std::size_t n_faces() const override { return faces(); }
  std::size_t n_edges() const override { return to_.size() / 2; }

 private:
  std::uint32_t checked(VertexHandle v) const;
  std::uint32_t checked(HalfedgeHandle h) const;
  void count(std::size_t& of) const;
  void addLoops();
  // Values of a feature are as many as its last vertex needs; take() fills the rest with zeros.
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
  std::vector<std::size_t> face_begin_;  // index into corners_
  std::vector<std::uint32_t> to_, next_, face_halfedge_;
  Values normal_{3, {}}, colour_{3, {}}, texcoord_{2, {}};
  OpenMesh::PolyMesh_ArrayKernelT<> empty_;
};

}  // namespace merlin::render
