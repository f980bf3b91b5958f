#include "render/mesh/io/openmesh/collector.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace merlin::render::mesh {

std::uint32_t Collector::checked(VertexHandle v) const {
  if (!v.is_valid() || static_cast<std::size_t>(v.idx()) >= vertices())
    throw BrokenFile(fmt::format("refers to vertex {}, but there are {}", v.idx(), vertices()));
  return static_cast<std::uint32_t>(v.idx());
}

std::uint32_t Collector::checked(HalfedgeHandle h) const {
  if (!h.is_valid() || static_cast<std::size_t>(h.idx()) >= to_.size())
    throw BrokenFile(fmt::format("refers to half-edge {}, but there are {}", h.idx(), to_.size()));
  return static_cast<std::uint32_t>(h.idx());
}

Collector::VertexHandle Collector::add_vertex(const OpenMesh::Vec3f& p) {
  if (vertices() >= most_) throw BrokenFile("has more vertices than its bytes can hold");
  positions_.insert(positions_.end(), {p[0], p[1], p[2]});
  return VertexHandle(static_cast<int>(vertices()) - 1);
}

void Collector::set_point(VertexHandle v, const OpenMesh::Vec3f& p) {
  for (std::size_t k = 0; k < 3; ++k)
    positions_[std::size_t{checked(v)} * 3 + k] = p[static_cast<unsigned>(k)];
}

Collector::FaceHandle Collector::add_face(const VHandles& corners) {
  if (corners_.size() + corners.size() > most_)
    throw BrokenFile("has more corners than its bytes can hold");
  face_begin_.push_back(corners_.size());
  for (const VertexHandle v : corners) corners_.push_back(checked(v));
  return FaceHandle(static_cast<int>(faces()) - 1);
}

Collector::HalfedgeHandle Collector::add_edge(VertexHandle from, VertexHandle to) {
  if (to_.size() + 2 > most_) throw BrokenFile("has more edges than its bytes can hold");
  to_.insert(to_.end(), {checked(to), checked(from)});
  next_.insert(next_.end(), {kNone, kNone});
  return HalfedgeHandle(static_cast<int>(to_.size()) - 2);
}

Collector::FaceHandle Collector::add_face(HalfedgeHandle h) {
  if (face_halfedge_.size() >= most_) throw BrokenFile("has more faces than its bytes can hold");
  face_halfedge_.push_back(checked(h));
  return FaceHandle(static_cast<int>(faces()) - 1);
}

void Collector::set_next(HalfedgeHandle h, HalfedgeHandle next) {
  // A half-edge at a border may have no next one.
  if (next.is_valid()) next_[checked(h)] = checked(next);
}

// Follows the loop of half-edges of each face and adds its corners. A half-edge belongs to one
// face, so all loops together are no longer than the number of half-edges.
void Collector::addLoops() {
  std::vector<bool> used(to_.size());
  for (std::size_t f = 0; f < face_halfedge_.size(); ++f) {
    face_begin_.push_back(corners_.size());
    std::uint32_t h = face_halfedge_[f];
    do {
      if (used[h])
        throw BrokenFile(fmt::format("has a face (number {}) whose edges do not form a loop", f));
      used[h] = true;
      corners_.push_back(to_[h]);
      h = next_[h];
      if (h == kNone)
        throw BrokenFile(fmt::format("has a face (number {}) whose edges do not form a loop", f));
    } while (h != face_halfedge_[f]);
  }
  face_halfedge_.clear();
}

Mesh Collector::take() {
  addLoops();
  Mesh mesh;
  for (std::size_t f = 0; f < face_begin_.size(); ++f) {
    const std::size_t end = f + 1 < face_begin_.size() ? face_begin_[f + 1] : corners_.size();
    for (std::size_t i = face_begin_[f] + 2; i < end; ++i)
      mesh.triangles.insert(mesh.triangles.end(),
                            {corners_[face_begin_[f]], corners_[i - 1], corners_[i]});
  }
  for (auto& [name, values] :
       {std::pair{"normal", &normal_}, {"colour", &colour_}, {"texcoord", &texcoord_}}) {
    if (values->values.empty()) continue;
    values->values.resize(vertices() * values->dimension);
    mesh.features.push_back({name, values->dimension, std::move(values->values)});
  }
  mesh.positions = std::move(positions_);
  return mesh;
}

}  // namespace merlin::render::mesh
