// FlatImporter: what OpenMesh's readers fill, in place of a half-edge mesh.
//
// A half-edge mesh would split non-manifold vertices and drop faces without a word; flat arrays
// take what the file says, and validate() judges it afterwards. Private to render/mesh/io.
#pragma once

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>

#include "render/mesh/mesh.h"

namespace merlin::render {

class FlatImporter final : public OpenMesh::IO::BaseImporter {
 public:
  using Vec2f = OpenMesh::Vec2f;
  using Vec3f = OpenMesh::Vec3f;
  using Vec3d = OpenMesh::Vec3d;
  using Vec4f = OpenMesh::Vec4f;
  using Vec3uc = OpenMesh::Vec3uc;
  using Vec4uc = OpenMesh::Vec4uc;
  using Vertex = OpenMesh::VertexHandle;
  using Halfedge = OpenMesh::HalfedgeHandle;
  using Edge = OpenMesh::EdgeHandle;
  using Face = OpenMesh::FaceHandle;
  using Status = OpenMesh::Attributes::StatusInfo;

  Vertex add_vertex(const Vec3f& p) override {
    mesh.positions.insert(mesh.positions.end(), {p[0], p[1], p[2]});
    return Vertex(static_cast<int>(mesh.vertexCount()) - 1);
  }
  Vertex add_vertex() override { return add_vertex(Vec3f(0, 0, 0)); }

  // A fan; a negative or far index stays what it is, for validate() to find.
  Face add_face(const VHandles& corners) override {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      for (const Vertex v : {corners[0], corners[i - 1], corners[i]}) {
        mesh.triangles.push_back(static_cast<std::uint32_t>(v.idx()));
      }
    }
    return Face(static_cast<int>(faces++));
  }

  void set_point(Vertex v, const Vec3f& p) override { set(mesh.positions, v, p); }
  void set_color(Vertex v, const Vec3f& c) override { set(colours, v, c); }
  void set_color(Vertex v, const Vec4f& c) override { set(colours, v, Vec3f(c[0], c[1], c[2])); }
  void set_color(Vertex v, const Vec3uc& c) override { set(colours, v, Vec3f(c) / 255.0F); }
  void set_color(Vertex v, const Vec4uc& c) override {
    set(colours, v, Vec3f(c[0], c[1], c[2]) / 255.0F);
  }

  size_t n_vertices() const override { return mesh.vertexCount(); }
  size_t n_faces() const override { return faces; }
  size_t n_edges() const override { return 0; }

  // What these formats do not carry, or MERLIN computes itself.
  Halfedge add_edge(Vertex, Vertex) override { return Halfedge(); }
  Face add_face(Halfedge) override { return Face(); }
  void add_face_texcoords(Face, Vertex, const std::vector<Vec2f>&) override {}
  void add_face_texcoords(Face, Vertex, const std::vector<Vec3f>&) override {}
  void set_face_texindex(Face, int) override {}
  void set_halfedge(Vertex, Halfedge) override {}
  void set_normal(Vertex, const Vec3f&) override {}
  void set_normal(Vertex, const Vec3d&) override {}
  void set_texcoord(Vertex, const Vec2f&) override {}
  void set_status(Vertex, const Status&) override {}
  void set_next(Halfedge, Halfedge) override {}
  void set_face(Halfedge, Face) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(Halfedge, const Vec2f&) override {}
  void set_texcoord(Vertex, const Vec3f&) override {}
  void set_texcoord(Halfedge, const Vec3f&) override {}
  void set_status(Halfedge, const Status&) override {}
  void set_color(Edge, const Vec3uc&) override {}
  void set_color(Edge, const Vec4uc&) override {}
  void set_color(Edge, const Vec3f&) override {}
  void set_color(Edge, const Vec4f&) override {}
  void set_status(Edge, const Status&) override {}
  void set_normal(Face, const Vec3f&) override {}
  void set_normal(Face, const Vec3d&) override {}
  void set_color(Face, const Vec3uc&) override {}
  void set_color(Face, const Vec4uc&) override {}
  void set_color(Face, const Vec3f&) override {}
  void set_color(Face, const Vec4f&) override {}
  void set_status(Face, const Status&) override {}
  void add_texture_information(int, std::string) override {}

  Mesh mesh;
  std::vector<float> colours;  // vertices x 3 so far; empty where none came
  std::size_t faces = 0;

 private:
  static void set(std::vector<float>& values, Vertex v, const Vec3f& row) {
    const std::size_t at = 3 * static_cast<std::size_t>(v.idx());
    if (v.idx() < 0) return;
    if (values.size() < at + 3) values.resize(at + 3, 0.0F);
    for (std::size_t k = 0; k < 3; ++k) values[at + k] = row[k];
  }
};

}  // namespace merlin::render
