// Simulates a scanner: computes the range image that a scanner would take of a mesh, by casting a
// ray for each pixel, and images of the modalities that the mesh has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/image/image_file.h"
#include "render/mesh/mesh.h"
#include "render/range/range_image.h"
#include "render/range/work.h"

namespace merlin::render::scan {

// The scene to scan.
struct Scene {
  const mesh::Mesh& mesh;
  // The mesh's decoded texture; nullptr: no texture. REQUIRES: with a texture, the mesh has
  // "texcoord" of dimension 2.
  const image::ImageFile* texture = nullptr;
};

struct ScanSettings {
  std::size_t width = 640, height = 480;
  range::Geometry geometry{};  // kOrthogonal, kSpinning or kPinhole
  // Standard deviation of the noise of ranges [units].
  double noise = 0;
  double drop_outs = 0;                              // share of the returns that are lost, 0..1
  double most_incidence_rad = std::numbers::pi / 2;  // more oblique surfaces give no return
  std::uint64_t seed = 1;                            // seed of noise and drop-outs
};

struct Scan {
  // Ranges, and one plane per modality with 0 where there is no return. The planes are: "colour"
  // (from the texture, else from the vertices); the vertices' other features of dimension 1
  // (interpolated; "label" and "part" are taken from the nearest corner); "confidence", the cosine
  // of the angle of incidence, 0..1.
  range::RangeImage image;
  std::size_t met = 0;                // number of rays that met the mesh
  std::size_t oblique = 0, lost = 0;  // of these: too oblique; lost by drop-outs or noise
  // Features of the mesh that did not become planes, except normals and texture coordinates.
  std::vector<std::string> left_out;
};

// Scans the mesh, whose triangles are opaque from both sides.
//
// A range is the exact distance of the triangle, rounded to float, plus normally distributed noise
// along the ray (for kPinhole along the depth). If noise makes a range 0 or less, the return is
// lost.
//
// errors  kInvalidArgument: faultOf() finds a fault; kMalformed: no ray meets the mesh.
// order   Each pixel has its own random numbers: the same seed gives the same image, whatever the
//         number of threads.
// cost    O((triangles + pixels) log triangles) time; 110 bytes per triangle, and per pixel 16
//         bytes and 4 for each value of a plane.
// REQUIRES: validate(mesh), at least one triangle. Reentrant.
Result<Scan> scan(const Scene& scene, const ScanSettings& settings, const range::Work& work);

}  // namespace merlin::render::scan
