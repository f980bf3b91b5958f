// `merlin mesh import` of point clouds: Open3D reconstructs a surface from them in the sandbox of
// merlin-import.
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "render/mesh/io/mesh_file.h"
#include "tests/support/clouds.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

constexpr int kPoints = 800;

// Returns points of the unit sphere with its centre moved by `x`, as text; red where z > 0 and blue
// below.
std::string colouredSphere(double x = 0) {
  std::string text;
  for (const auto& p : sphere(kPoints))
    text += fmt::format("{:.6f} {:.6f} {:.6f} {}\n", p[0] + x, p[1], p[2],
                        p[2] > 0 ? "255 0 0" : "0 0 255");
  return text;
}

constexpr const char* kTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
    "3 0 1 2\n";

class PointsImport : public testing::Test {
 protected:
  Outcome import(const std::string& bytes, std::vector<std::string> options = {}) {
    writeText(dir_ / "cloud", bytes);
    options.insert(options.begin(), {kMerlin, "mesh", "import", dir_ / "cloud", "-o", ply_});
    return run(std::move(options));
  }
  nlohmann::json report(const std::string& bytes, std::vector<std::string> options = {}) {
    options.emplace_back("--json");
    const Outcome outcome = import(bytes, std::move(options));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    const auto start = outcome.output.find("{\"input\"");
    return start == std::string::npos ? nlohmann::json()
                                      : nlohmann::json::parse(outcome.output.substr(start));
  }
  render::mesh::Mesh written() {
    auto loaded = render::mesh::readMesh(ply_);
    EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().what);
    return loaded ? std::move(loaded->mesh) : render::mesh::Mesh{};
  }

  TempDir dir_;
  std::string ply_ = dir_ / "out.ply";
};

// Returns six times the signed volume of the surface; positive if the surface is closed and faces
// outwards.
double volume(const render::mesh::Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const float* a = &mesh.positions[3 * mesh.triangles[t]];
    const float* b = &mesh.positions[3 * mesh.triangles[t + 1]];
    const float* c = &mesh.positions[3 * mesh.triangles[t + 2]];
    sum += double{a[0]} * (b[1] * c[2] - b[2] * c[1]) + double{a[1]} * (b[2] * c[0] - b[0] * c[2]) +
           double{a[2]} * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

TEST_F(PointsImport, PointsOfASphereBecomeTheSameClosedSphereOfTheirColoursEachTime) {
  const auto json = report(colouredSphere());
  EXPECT_EQ(json["format"], "XYZ text");
  EXPECT_EQ(json["cloud"]["points"], kPoints);
  EXPECT_EQ(json["cloud"]["neighbours"], 16);
  EXPECT_EQ(json["cloud"]["depth"], 4);
  EXPECT_EQ(json["cloud"]["trimmed_triangles"], 0);
  const auto mesh = written();
  ASSERT_GT(mesh.triangleCount(), 500U);
  EXPECT_EQ(2 * mesh.vertexCount(), mesh.triangleCount() + 4) << "a closed surface without holes";
  EXPECT_NEAR(volume(mesh), 4.19, 0.1) << "and it faces outwards";
  const auto* colour = mesh.find("colour");
  ASSERT_NE(colour, nullptr);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const float* p = &mesh.positions[3 * v];
    EXPECT_NEAR(std::sqrt(render::mesh::dot(p, p)), 1, 0.03);
    if (std::abs(p[2]) < 0.2F) continue;
    EXPECT_NEAR(colour->values[3 * v], p[2] > 0 ? 1 : 0, 0.01);
    EXPECT_NEAR(colour->values[3 * v + 2], p[2] > 0 ? 0 : 1, 0.01);
  }
  const std::string first = readText(ply_);
  ASSERT_EQ(import(colouredSphere()).status, 0);
  EXPECT_TRUE(readText(ply_) == first);
}

TEST_F(PointsImport, WhereThereAreNoPointsTheSurfaceIsTrimmed) {
  std::string half;
  for (const auto& p : sphere(kPoints))
    if (p[2] > 0) half += fmt::format("{:.6f} {:.6f} {:.6f}\n", p[0], p[1], p[2]);
  EXPECT_GT(report(half, {"--trim", "0.3"})["cloud"]["trimmed_triangles"], 0);
  const auto open = written();
  for (std::size_t v = 0; v < open.vertexCount(); ++v) EXPECT_GT(open.positions[3 * v + 2], -0.3F);
  EXPECT_EQ(report(half, {"--trim", "0"})["cloud"]["trimmed_triangles"], 0);
}

TEST_F(PointsImport, TheOriginOfLargeCoordinatesIsSaid) {
  const auto json =
      report(colouredSphere(500'000), {"--depth", "5", "--neighbours", "10", "--local"});
  const double x = json["cloud"]["origin"][0];
  EXPECT_NEAR(x, 500'000, 1);
  EXPECT_EQ(json["cloud"]["neighbours"], 10);
  double mean = 0;
  const auto mesh = written();
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mean += double{mesh.positions[3 * v]};
  EXPECT_NEAR(x + mean / static_cast<double>(mesh.vertexCount()), 500'000, 0.01);
}

TEST_F(PointsImport, AnExportLiesWhereThePointsDo) {
  ply_ = dir_ / "out.mrm";
  ASSERT_EQ(import(colouredSphere(500'000), {"--depth", "5"}).status, 0);
  const Outcome done = run({kMerlin, "mesh", "export", ply_, "-o", dir_ / "b.ply"});
  ASSERT_EQ(done.status, 0) << done.output;
  const auto loaded = render::mesh::readMesh(dir_ / "b.ply");
  ASSERT_TRUE(loaded) << loaded.error().what;
  double mean = 0;
  const auto& positions = loaded->mesh.positions;
  for (std::size_t i = 0; i < positions.size(); i += 3) mean += loaded->origin[0] + positions[i];
  EXPECT_NEAR(mean / static_cast<double>(loaded->mesh.vertexCount()), 500'000, 0.01);
}

TEST_F(PointsImport, TheOriginIsScaledWithThePoints) {
  const auto json = report(colouredSphere(500'000),
                           {"--depth", "5", "--neighbours", "10", "--scale", "0.5", "--local"});
  EXPECT_NEAR(json["cloud"]["origin"][0], 250'000, 1);
  double mean = 0;
  const auto mesh = written();
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mean += double{mesh.positions[3 * v]};
  EXPECT_NEAR(
      json["cloud"]["origin"][0].get<double>() + mean / static_cast<double>(mesh.vertexCount()),
      250'000, 0.01);
}

TEST_F(PointsImport, AProjectionStaysInTheModel) {
  const auto points = sphere(kPoints);
  std::string bytes = las(2, 0, kPoints);
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t k = 0; k < 3; ++k)
      set32(
          bytes, 227 + 20 * p + 4 * k,
          static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(1000 * points[p][k]))));
  }
  std::string record(54, '\0');
  record.replace(2, 15, "LASF_Projection");
  const std::string wkt = "PROJCS[\"WGS 84 / UTM zone 33N\",x\\y]";
  set16(record, 18, 2112);
  set16(record, 20, static_cast<std::uint32_t>(wkt.size()));
  set32(bytes, 96, static_cast<std::uint32_t>(227 + 54 + wkt.size()));
  set32(bytes, 100, 1);
  bytes.insert(227, record + wkt);
  const auto json = report(bytes);
  EXPECT_EQ(json["cloud"]["projection"], wkt);
  ply_ = dir_ / "out.mrm";
  ASSERT_EQ(import(bytes).status, 0);
  const Outcome info = run({kMerlin, "mesh", "info", ply_, "--json"});
  const std::string about = nlohmann::json::parse(info.output)["about"];
  EXPECT_NE(about.find("map.projection=" + wkt + "\n"), std::string::npos) << about;
}

#if !defined(MERLIN_ANY_SANITIZER)  // a sanitizer needs terabytes of address space
TEST_F(PointsImport, TooLittleMemoryIsSaidWithTheWayOut) {
  // A sparse file that is larger than the memory limit.
  writeText(dir_ / "large.las", "LASF");
  std::filesystem::resize_file(dir_ / "large.las", std::size_t{101} << 20);
  const Outcome outcome =
      run({kMerlin, "mesh", "import", dir_ / "large.las", "-o", ply_, "--memory", "100M"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.output.find("large.las: reading it takes more memory than the 100 MB that are "
                                "allowed (--memory, by default the free memory)"),
            std::string::npos)
      << outcome.output;
}
#endif

TEST_F(PointsImport, WhatCannotBeASurfaceIsRefusedInOneLine) {
  const auto refusal = [&](const std::string& bytes, std::vector<std::string> options = {}) {
    const Outcome outcome = import(bytes, std::move(options));
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_EQ(std::ranges::count(outcome.output, '\n'), 1) << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(ply_));
    return outcome.output;
  };
  EXPECT_NE(refusal("1 2 3\n4 5 6\n7 8 9\n").find("3 points"), std::string::npos);
  std::string one;
  for (int p = 0; p < 20; ++p) one += "1 2 3\n";
  EXPECT_NE(refusal(one).find("lie in one place"), std::string::npos);
  EXPECT_NE(refusal("ASTM-E57").find("pdal translate"), std::string::npos);
  EXPECT_NE(refusal(colouredSphere(), {"--geometry", "elevation"}).find("--geometry"),
            std::string::npos);
  EXPECT_NE(refusal(kTriangle, {"--depth", "7"}).find("--depth"), std::string::npos);
}

}  // namespace
}  // namespace merlin::test
