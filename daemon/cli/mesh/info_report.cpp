#include "daemon/cli/mesh/info_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

using render::mesh::Hole;
using render::mesh::Inspection;

// Returns the possible oddities of a surface: key in JSON, description for a person, and number of
// occurrences.
std::vector<Repair> oddities(const Inspection& is) {
  return {{"degenerate", "triangles with two corners at one place", is.degenerate},
          {"no_area", "triangles without area", is.no_area},
          {"duplicate", "triangles with the same corners as another", is.duplicate},
          {"non_manifold_edges", "edges with more than two triangles", is.non_manifold_edges},
          {"turned_edges", "edges whose two triangles face different ways", is.turned_edges},
          {"non_manifold_vertices", "vertices where parts of the surface only touch",
           is.non_manifold_vertices},
          {"isolated", "vertices that no triangle uses", is.isolated},
          {"not_finite", "vertices that are not numbers", is.not_finite},
          {"normals_not_unit", "normals that are not of length one", is.not_unit},
          {"inside_out", "closed parts that face inwards", is.inside_out}};
}

double totalLength(const Inspection& is) {
  double length = 0;
  for (const Hole& hole : is.holes) length += hole.length;
  return length;
}

nlohmann::ordered_json featuresOf(const FileInfo& info) {
  auto features = nlohmann::ordered_json::array();
  for (const FeatureInfo& f : info.features) {
    features.push_back({{"name", f.name},
                        {"dimension", f.dimension},
                        {"range", {f.range.low, f.range.high}},
                        {"unit", f.unit},
                        {"not_numbers", f.range.not_numbers}});
  }
  return features;
}

void printSurface(const Inspection& is) {
  std::string text = fmt::format("{} connected, {} of them closed", is.components, is.closed);
  if (is.closed > 0) text += fmt::format(", volume {:.6g}", is.volume);
  printOut("  parts     {}\n", text);
  if (is.holes.empty()) {
    printOut("  holes     none\n");
  } else {
    printOut("  holes     {} (outlines included), border {:.6g} long, the longest {:.6g}\n",
             is.holes.size(), totalLength(is), is.holes.front().length);
  }
  for (const Repair& odd : oddities(is)) {
    if (odd.count > 0) printOut("  odd       {} {}\n", odd.count, odd.name);
  }
}

// Returns the possible oddities of a point cloud. "isolated" is left out, because it would apply to
// every point.
std::vector<Repair> oddities(const CloudInfo& cloud, const Inspection& is) {
  return {{"coincident", "points at the same place as an earlier point", cloud.coincident},
          {"normals_not_unit", "normals that are not of length one", is.not_unit}};
}

nlohmann::ordered_json jsonOf(const CloudInfo& cloud, const render::mesh::Origin& origin,
                              const Inspection& is) {
  nlohmann::ordered_json json = {{"points", cloud.points}, {"origin", origin}};
  for (const Repair& odd : oddities(cloud, is)) json[odd.key] = odd.count;
  return json;
}

void printPlace(const FileInfo& info) {
  const auto& origin = info.origin;
  if (origin != render::mesh::Origin{})
    printOut("  origin    {}, {}, {}: the box is relative to it\n", origin[0], origin[1],
             origin[2]);
  if (!info.projection.empty()) printOut("  map       projection {}\n", info.projection);
}

void printCloud(const CloudInfo& cloud, const Inspection& is) {
  for (const Repair& odd : oddities(cloud, is)) {
    if (odd.count > 0) printOut("  odd       {} {}\n", odd.count, odd.name);
  }
}

void printFeature(const FeatureInfo& f) {
  std::string text =
      fmt::format("{} x {}, {:.6g} to {:.6g}", f.name, f.dimension, f.range.low, f.range.high);
  if (!f.unit.empty()) text += " " + f.unit;
  if (f.range.not_numbers > 0) text += fmt::format(", {} are not numbers", f.range.not_numbers);
  printOut("  feature   {}\n", text);
}

void printAbout(std::string_view about) {
  while (!about.empty()) {
    const std::size_t n = std::min(about.find('\n'), about.size());
    const std::string_view line = about.substr(0, n);
    if (!line.starts_with("unit="))
      printOut("  made by   {}\n", line);  // the line about the unit is printed above
    about.remove_prefix(std::min(n + 1, about.size()));
  }
}

}  // namespace

void printInfoJson(const FileInfo& info) {
  const Inspection& is = info.is;
  nlohmann::ordered_json json = {{"file", info.file},
                                 {"format", info.format},
                                 {"triangles", info.triangles},
                                 {"vertices", info.vertices},
                                 {"levels", info.levels.levels},
                                 {"triangles_coarsest", info.levels.coarsest},
                                 {"features", featuresOf(info)},
                                 {"texture_bytes", info.texture_bytes},
                                 {"box", {{"low", is.box.low}, {"high", is.box.high}}},
                                 {"diagonal", is.box.diagonal()},
                                 {"unit", info.unit},
                                 {"origin", info.origin},
                                 {"components", is.components},
                                 {"closed_components", is.closed},
                                 {"volume", is.volume},
                                 {"holes",
                                  {{"count", is.holes.size()},
                                   {"length", totalLength(is)},
                                   {"longest", is.holes.empty() ? 0 : is.holes.front().length}}},
                                 {"about", info.about}};
  if (!info.cloud)
    for (const Repair& odd : oddities(is)) json["odd"][odd.key] = odd.count;
  if (info.parts) json["parts"] = *info.parts;
  if (info.cloud) json["cloud"] = jsonOf(*info.cloud, info.origin, is);
  if (!info.projection.empty()) json["projection"] = info.projection;
  if (info.image) {
    json["image"] = {{"columns", info.image->width},
                     {"rows", info.image->height},
                     {"returns", info.image->returns},
                     {"geometry", info.image->geometry}};
  }
  for (const Repair& r : info.repairs) json[r.key] = r.count;
  printJsonLine(json);
}

void printInfoText(const FileInfo& info) {
  const render::mesh::Box& box = info.is.box;
  if (info.cloud)
    printOut("{}: {} points\n", info.file, info.cloud->points);
  else
    printOut("{}: {} triangles, {} vertices\n", info.file, info.triangles, info.vertices);
  printOut("  format    {}\n", info.format);
  if (const auto& image = info.image) {
    printOut(
        "  image     {} columns x {} rows, {} pixels with a return, {}; triangles and what\n"
        "            follows from them are those of `merlin mesh import` without filters\n",
        image->width, image->height, image->returns, image->geometry);
  }
  if (info.levels.levels > 1) {
    printOut("  levels    {}, down to {} triangles (error estimate {:.3g})\n", info.levels.levels,
             info.levels.coarsest, info.levels.error);
  }
  for (const FeatureInfo& f : info.features) printFeature(f);
  if (info.texture_bytes > 0) printOut("  texture   {} bytes\n", info.texture_bytes);
  printOut("  box       {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}, diagonal {:.6g}\n",
           box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2],
           box.diagonal());
  printOut("  unit      {}\n", info.unit.empty() ? "not known" : info.unit);
  printPlace(info);
  if (info.cloud) printCloud(*info.cloud, info.is);
  if (info.triangles > 0) printSurface(info.is);
  if (!info.mended.empty()) printOut("  {}\n", info.mended);
  printAbout(info.about);
}

}  // namespace merlin::cli
