// merlin mesh compare: measures the distance between two surfaces.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/mesh/compare_options.h"
#include "daemon/cli/mesh/compare_pictures.h"
#include "daemon/cli/mesh/mesh.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "render/compare/compare.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::string original, other;
  LevelChoice choice;  // resolution of `other`
  render::compare::CompareSettings settings;
  std::string pictures;  // folder for pictures; empty: none
  View view;
  bool json = false;
};

struct Answer {
  render::compare::Comparison comparison;
  double seconds = 0;
  // Share of the pixels that differ [percent], if pictures were drawn.
  std::optional<double> changed_percent;
};

// One quantity of a Deviation, with its name in the table and its key in the JSON output.
struct Figure {
  const char* name;
  const char* key;
  std::optional<double> value;
  // Whether `value` is in model units, and also printed in percent of the diagonal.
  bool is_length = false;
};

std::optional<double> colourError(const render::compare::Deviation& d) {
  for (const auto& f : d.features) {
    if (f.name == "colour") return 255 * f.rms;
  }
  return std::nullopt;
}

std::vector<Figure> figuresOf(const render::compare::Deviation& d) {
  return {{"RMS", "rms", d.rms, true},
          {"mean", "mean", d.mean, true},
          {"max, at least", "max_low", d.max.low, true},
          {"max, at most", "max_high", d.max.high, true},
          {"colour RMS of 255", "colour_rms_255", colourError(d)},
          {"facets' normals RMS, degrees", "normal_rms_deg", d.facet_rms_deg},
          {"vertex normals RMS, degrees", "vertex_normal_rms_deg", d.normal_rms_deg}};
}

// Returns the value as JSON; null if there is none.
Json valueOf(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json jsonOf(const render::compare::Deviation& d, double diagonal) {
  Json json;
  for (const Figure& f : figuresOf(d)) {
    json[f.key] = valueOf(f.value);
    if (f.is_length) json[std::string(f.key) + "_percent"] = 100 * *f.value / diagonal;
  }
  json["features"] = Json::object();
  for (const auto& f : d.features) json["features"][f.name] = f.rms;
  json["points_tested"] = d.max.evaluations;
  return json;
}

void printComparisonJson(const CompareOptions& options, const Answer& answer) {
  const render::compare::Comparison& c = answer.comparison;
  Json json = {{"original", options.original}, {"other", options.other}, {"diagonal", c.diagonal}};
  json.update(jsonOf(c.symmetric(), c.diagonal));
  json["forward"] = jsonOf(c.forward, c.diagonal);
  json["backward"] = jsonOf(c.backward, c.diagonal);
  if (answer.changed_percent) json["changed_pixels_percent"] = *answer.changed_percent;
  json["seconds"] = answer.seconds;
  printJsonLine(json);
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

void printComparisonTable(const CompareOptions& options, const Answer& answer) {
  const render::compare::Comparison& c = answer.comparison;
  printOut("{} (A) and {} (B): diagonal of A {:.6g}, {:.1f} s\n", options.original, options.other,
           c.diagonal, answer.seconds);
  printOut("{:30}{:>12}{:>12}{:>12}{:>16}\n", "", "A to B", "B to A", "larger", "% of diagonal");
  const render::compare::Deviation symmetric = c.symmetric();
  const auto forward = figuresOf(c.forward), backward = figuresOf(c.backward);
  const auto larger = figuresOf(symmetric);
  for (std::size_t i = 0; i < larger.size(); ++i) {
    if (!larger[i].value) continue;
    const std::string percent =
        larger[i].is_length ? fmt::format("{:.4f}", 100 * *larger[i].value / c.diagonal) : "";
    printOut("{:30}{:>12}{:>12}{:>12}{:>16}\n", larger[i].name, cell(forward[i].value),
             cell(backward[i].value), cell(larger[i].value), percent);
  }
  for (std::size_t i = 0; i < symmetric.features.size(); ++i) {
    printOut("{:30}{:>12.4g}{:>12.4g}{:>12.4g}\n", symmetric.features[i].name + " RMS",
             c.forward.features[i].rms, c.backward.features[i].rms, symmetric.features[i].rms);
  }
  if (answer.changed_percent) {
    printOut(
        "pixels that differ by more than 15 %: {:.3g} % of the model's pixels "
        "({}/difference.png)\n",
        *answer.changed_percent, options.pictures);
  }
}

struct PlacedMesh {
  render::mesh::Mesh mesh;
  render::mesh::Origin origin{};
};

Result<PlacedMesh> openMesh(const std::string& path, const LevelChoice& choice) {
  PlacedMesh placed;
  const auto model = openModel(path, &placed.origin);
  if (!model) return model.error();
  const auto level = choice.levelOf(*model, path);
  if (!level) return level.error();
  placed.mesh = render::lod::extract(*model, *level);
  return placed;
}

// Returns the origin of the coordinates of `placed`. A mesh without an origin whose coordinates are
// near 0, as after an export with --local, is taken to be relative to `others`, the origin of the
// other mesh; a mesh with large coordinates has the origin 0 0 0.
render::mesh::Origin originOf(const PlacedMesh& placed, const render::mesh::Origin& others) {
  const render::mesh::Origin none{};
  const std::vector<float>& p = placed.mesh.positions;
  if (placed.origin != none || p.empty()) return placed.origin;
  return render::mesh::originNear({p[0], p[1], p[2]}) == none ? others : none;
}

// Makes the coordinates of the other mesh relative to the origin of the original.
void moveTo(const PlacedMesh& original, PlacedMesh& other) {
  const auto from = originOf(other, original.origin), to = originOf(original, other.origin);
  if (from == to) return;
  std::vector<float>& positions = other.mesh.positions;
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = static_cast<float>(positions[i] + (from[i % 3] - to[i % 3]));
}

Result<render::compare::Comparison> compared(const CompareOptions& options,
                                             const render::mesh::Mesh& original,
                                             const render::mesh::Mesh& other, const Clock& clock) {
  ProgressBar bar("comparing", "points", clock);
  std::size_t points = 0;
  auto comparison = render::compare::compare(original, other, options.settings,
                                             [&](const render::compare::CompareProgress& p) {
                                               points = p.points;
                                               bar.update(p.share, p.points);
                                               return true;
                                             });
  if (!comparison) {
    return Error{comparison.error().code, fmt::format("{}, {}: {}", options.original, options.other,
                                                      comparison.error().what)};
  }
  bar.finish(points);
  return comparison;
}

int compareMeshes(const CompareOptions& options) {
  const auto original = openMesh(options.original, {});
  if (!original) return fail(original.error());
  auto other = openMesh(options.other, options.choice);
  if (!other) return fail(other.error());
  moveTo(*original, *other);
  Answer answer;
  // The pictures come before the long comparison, so that an error is reported early.
  if (!options.pictures.empty()) {
    render::gl::prepareSoftwareGl(0);
    const auto changed = writePictures(options.pictures, original->mesh, other->mesh, options.view);
    if (!changed) return fail(changed.error());
    answer.changed_percent = *changed;
  }
  const SystemClock clock;
  const Timestamp began = clock.now();
  const auto comparison = compared(options, original->mesh, other->mesh, clock);
  if (!comparison) return fail(comparison.error());
  answer.comparison = *comparison;
  answer.seconds = toSeconds(clock.now() - began);
  (options.json ? printComparisonJson : printComparisonTable)(options, answer);
  return kExitDone;
}

}  // namespace

void addMeshCompare(Command mesh, Run& run) {
  const auto options = std::make_shared<CompareOptions>();
  Command command =
      mesh.subcommand("compare",
                      "Measure the distance between two surfaces: RMS, mean, and a certified "
                      "interval that contains the "
                      "maximum.\nExample: merlin mesh compare scan.ply scan.mrm --percent 5");
  command
      .option("a", options->original,
              "The original surface: .mrm, " + render::mesh::readableEndings())
      .required()
      .typeName("A");
  command
      .option("b", options->other,
              "The surface to compare with it: .mrm, " + render::mesh::readableEndings())
      .required()
      .typeName("B");
  options->choice.addTo(command);
  addCompareOptions(command, options->settings);
  command.option("--feature", options->settings.features,
                 "Features to compare; the default is every feature that both surfaces have");
  command
      .option(
          "--pictures", options->pictures,
          "Write PNG files into this folder: a and b; a_wire and b_wire (wireframes); beside (a "
          "and b side by side); difference (pixels that differ by more than 15 %); edges (edges "
          "of B coloured by length, from red for the shortest to blue)")
      .typeName("DIR");
  options->view.addTo(command);
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return compareMeshes(*options); }; });
}

}  // namespace merlin::cli
