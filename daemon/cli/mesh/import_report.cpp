#include "daemon/cli/mesh/import_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/printable_text.h"
#include "daemon/base/process_memory.h"
#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

nlohmann::ordered_json jsonOf(const ImportTimes& times) {
  return {{"reading", times.reading},   {"filtering", times.filtering}, {"meshing", times.meshing},
          {"reducing", times.reducing}, {"writing", times.writing},     {"all", times.all()}};
}

// Returns the members of the JSON report that are the same for range images and for models.
nlohmann::ordered_json jsonOf(const ImportNames& names, const std::string& format,
                              const ImportedFile& written, const ImportTimes& times) {
  nlohmann::ordered_json json = {{"input", names.input},
                                 {"output", names.output},
                                 {"format", format},
                                 {"triangles", written.triangles},
                                 {"vertices", written.vertices},
                                 {"companion_files", written.mesh.companions},
                                 {"left_out", written.mesh.left_out},
                                 {"seconds", jsonOf(times)},
                                 {"peak_memory_mb", peakMemory() >> 20}};
  if (written.coarsest) json["triangles_coarsest"] = *written.coarsest;
  return json;
}

nlohmann::ordered_json finiteOrNull(float value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

void addOrigin(const ImportNames& names, const render::mesh::Origin& origin,
               const ImportedFile& written, nlohmann::ordered_json& json) {
  if (origin == render::mesh::Origin{}) return;
  json["origin"] = origin;
  json["origin_added"] = written.isMesh() && hasOrigin(origin, names.local, written.mesh);
}

void printPlace(const ImportNames& names, const render::mesh::Origin& origin,
                const ImportedFile& written) {
  if (written.isMesh())
    printOrigin(origin, names.local, written.mesh);
  else if (origin != render::mesh::Origin{})
    printOut("  origin    the model's (0, 0, 0) is at {}, {}, {}\n", origin[0], origin[1],
             origin[2]);
}

void addRange(const ImportNames& names, const ImportedRange& range, const ImportedFile& written,
              nlohmann::ordered_json& json) {
  Json features = Json::array();
  for (const FeatureFacts& f : range.features) {
    Json feature = {{"name", f.name}, {"dimension", f.dimension}};
    if (!f.unit.empty()) feature["unit"] = f.unit;
    if (f.dimension == 1) feature["range"] = {f.low, f.high};
    features.push_back(std::move(feature));
  }
  const auto& mesh = range.mesh;
  json["geometry"] = render::range::nameOf(range.image.geometry.scanner);
  json["width"] = range.image.width;
  json["height"] = range.image.height;
  json["returns"] = range.returns_in_file;
  json["outside_removed"] = range.outside;
  json["spikes_removed"] = range.spikes;
  json["unused"] = mesh.unused;
  json["vertices_added"] = mesh.split;
  json["border_vertices"] = std::count(mesh.on_boundary.begin(), mesh.on_boundary.end(), 1);
  json["max_edge_length"] = finiteOrNull(range.max_edge.length);
  json["max_edge_percent"] = finiteOrNull(100 * range.max_edge.per_range);
  json["features"] = std::move(features);
  const auto& geometry = range.image.geometry;
  if (!geometry.projection.empty()) json["projection"] = geometry.projection;
  addOrigin(names, range.origin, written, json);
  if (geometry.origin) json["origin"] = *geometry.origin;  // an origin on a map has no height
  json["notes"] = range.notes;
}

// Returns the name of a map projection, which is the first text in quotes; without quotes, the
// beginning of the text.
std::string nameOfProjection(const std::string& text) {
  const std::size_t from = text.find('"');
  const std::size_t to = text.find('"', from == std::string::npos ? from : from + 1);
  return to == std::string::npos ? excerpt(text) : excerpt(text.substr(from + 1, to - from - 1));
}

// Prints the projection and the origin of a map, if one is known. `origin`: origin of the mesh,
// which printPlace() prints.
void printMap(const render::range::Geometry& geometry, const render::mesh::Origin& origin) {
  if (geometry.projection.empty() && !geometry.origin) return;
  std::string text = geometry.projection.empty()
                         ? "projection unknown"
                         : "projection " + nameOfProjection(geometry.projection);
  if (geometry.origin)
    text += fmt::format("; {} is at {}, {}",
                        origin == render::mesh::Origin{} ? "the mesh's (0, 0)"
                                                         : "the middle of its lower left pixel",
                        (*geometry.origin)[0], (*geometry.origin)[1]);
  printOut("  map       {}\n", text);
}

void printFeatures(const ImportedRange& range) {
  for (const FeatureFacts& f : range.features) {
    if (f.dimension == 1)
      printOut("  feature   {}, {:.6g} to {:.6g}{}{}\n", f.name, f.low, f.high,
               f.unit.empty() ? "" : " ", f.unit);
    else
      printOut("  feature   {} x {}\n", f.name, f.dimension);
  }
}

void printTimes(const ImportedFile& written, const ImportTimes& times) {
  printWritten(written.mesh);
  if (written.coarsest) printOut("  levels    down to {} triangles\n", *written.coarsest);
  printOut("  {:.2f} s: reading {:.2f}, filtering {:.2f}, meshing {:.2f}", times.all(),
           times.reading, times.filtering, times.meshing);
  if (written.coarsest) printOut(", reducing {:.2f}", times.reducing);
  printOut(", writing {:.2f}; peak memory {} MB\n", times.writing, peakMemory() >> 20);
}

nlohmann::ordered_json jsonOf(const PointFacts& cloud) {
  return {{"points", cloud.points},        {"spacing", cloud.spacing},
          {"depth", cloud.used.depth},     {"neighbours", cloud.used.neighbours},
          {"trim", cloud.used.trim},       {"trimmed_triangles", cloud.trimmed},
          {"normals", cloud.normals},      {"origin", cloud.origin},
          {"projection", cloud.projection}};
}

void printCloud(const std::string& format, const PointFacts& cloud) {
  printOut("  read      {}, {} points, {:.6g} apart\n", format, cloud.points, cloud.spacing);
  if (!cloud.projection.empty())
    printOut("  map       projection {}\n", nameOfProjection(cloud.projection));
  printOut("  normals   {}\n", cloud.normals);
  if (cloud.used.trim > 0)
    printOut(
        "  surface   Poisson, --depth {}; --trim {:.6g} removed {} triangles that are not near a "
        "point\n",
        cloud.used.depth, cloud.used.trim, cloud.trimmed);
  else
    printOut("  surface   Poisson, --depth {}; nothing was trimmed\n", cloud.used.depth);
}

}  // namespace

void reportRange(const ImportNames& names, const ImportedRange& range, const ImportedFile& written,
                 const ImportTimes& times) {
  if (names.json) {
    auto json = jsonOf(names, range.format, written, times);
    addRange(names, range, written, json);
    printJsonLine(json);
    return;
  }
  const auto& image = range.image;
  const auto& mesh = range.mesh;
  if (written.triangles > 0)
    printOut("{}: {} triangles, {} vertices\n", names.output, written.triangles, written.vertices);
  else  // the output is a range image
    printOut("{}: {} x {} pixels, {} with a return\n", names.output, image.width, image.height,
             std::count_if(image.range.begin(), image.range.end(), render::range::isReturn));
  printOut("  read      {}, {} x {} pixels, {} with a return, {}\n", range.format, image.width,
           image.height, range.returns_in_file, render::range::nameOf(image.geometry.scanner));
  if (range.outside + range.spikes > 0)
    printOut("  removed   {} returns outside --between, {} spikes\n", range.outside, range.spikes);
  printMap(image.geometry, range.origin);
  printPlace(names, range.origin, written);
  printFeatures(range);
  if (written.triangles > 0)
    printOut(
        "  surface   {}; {} vertices on borders, {} returns in no triangle, {} vertices added "
        "where surfaces touch in a point\n",
        range.max_edge_text, std::count(mesh.on_boundary.begin(), mesh.on_boundary.end(), 1),
        mesh.unused, mesh.split);
  printTimes(written, times);
}

void reportModel(const ImportNames& names, const ImportedModel& model, const ImportedFile& written,
                 const ImportTimes& times) {
  const render::mesh::Mesh& mesh = model.loaded.mesh;
  if (names.json) {
    auto json = jsonOf(names, model.format, written, times);
    if (model.parts) {
      json["parts"] = *model.parts;
      json["welded_edges"] = model.welded_edges;
      json["welded_vertices"] = model.welded_vertices;
    }
    addOrigin(names, model.origin(), written, json);
    if (model.cloud) json["cloud"] = jsonOf(*model.cloud);
    json["features"] = nlohmann::ordered_json::array();
    for (const auto& f : mesh.features)
      json["features"].push_back({{"name", f.name}, {"dimension", f.dimension}});
    json["texture_bytes"] = mesh.texture.size();
    json["notes"] = model.notes;
    for (const Repair& repair : repairsOf(model.loaded)) json[repair.key] = repair.count;
    model.outwards.addTo(json);
    printJsonLine(json);
    return;
  }
  printOut("{}: {} triangles, {} vertices\n", names.output, written.triangles, written.vertices);
  if (model.cloud) printCloud(model.format, *model.cloud);
  printPlace(names, model.origin(), written);
  if (model.parts) printOut("  read      {}, {} parts\n", model.format, *model.parts);
  if (model.welded_vertices > 0)
    printOut("  welded    {} vertices of different parts, along {} common edges\n",
             model.welded_vertices, model.welded_edges);
  for (const auto& f : mesh.features) printOut("  feature   {} x {}\n", f.name, f.dimension);
  if (!mesh.texture.empty()) printOut("  texture   {} bytes\n", mesh.texture.size());
  const std::string mended = mendedText(model.loaded);
  if (!mended.empty()) printOut("  {}\n", mended);
  printTimes(written, times);
}

}  // namespace merlin::cli
