// Turns an organised cloud into a mesh with the Point Cloud Library, for ./dev bench range:
//
//   range_peer_pcl IN.pcd OUT.ply MOST_EDGE ROUNDS
//
// reads, median-filters, triangulates and writes ROUNDS times, and prints the medians of the steps
// as one JSON object [ms]. It has no filter for spikes and computes no normals, so it does less
// than MERLIN. render/range/README.md says why it is the only peer.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <pcl/conversions.h>
#include <pcl/filters/median_filter.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <pcl/surface/organized_fast_mesh.h>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;
using Clock = std::chrono::steady_clock;

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const float most_edge = std::strtof(argv[3], nullptr);
  const int rounds = std::atoi(argv[4]);
  std::vector<double> reading, filtering, meshing, writing, all;
  std::size_t triangles = 0;
  for (int round = 0; round <= rounds; ++round) {
    const auto began = Clock::now();
    auto lap = began;
    const auto step = [&](std::vector<double>& ms) {
      const auto now = Clock::now();
      if (round > 0) ms.push_back(std::chrono::duration<double, std::milli>(now - lap).count());
      lap = now;
    };
    Cloud::Ptr cloud(new Cloud), smooth(new Cloud);
    if (pcl::io::loadPCDFile(argv[1], *cloud) != 0) return 1;
    step(reading);
    pcl::MedianFilter<pcl::PointXYZRGB> median;
    median.setInputCloud(cloud);
    median.setWindowSize(3);
    median.filter(*smooth);
    step(filtering);
    pcl::OrganizedFastMesh<pcl::PointXYZRGB> mesher;
    mesher.setInputCloud(smooth);
    mesher.setTriangulationType(pcl::OrganizedFastMesh<pcl::PointXYZRGB>::TRIANGLE_ADAPTIVE_CUT);
    mesher.setTrianglePixelSize(1);
    mesher.setMaxEdgeLength(most_edge);
    pcl::PolygonMesh mesh;
    mesher.reconstruct(mesh);
    triangles = mesh.polygons.size();
    step(meshing);
    if (pcl::io::savePLYFileBinary(argv[2], mesh) < 0) return 1;
    step(writing);
    lap = began;
    step(all);
  }
  std::printf(
      "{\"reading\": %.3f, \"filtering\": %.3f, \"meshing\": %.3f, \"writing\": %.3f, \"all\": "
      "%.3f, "
      "\"triangles\": %zu}\n",
      medianOf(reading), medianOf(filtering), medianOf(meshing), medianOf(writing), medianOf(all),
      triangles);
  return 0;
}
