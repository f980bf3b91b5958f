#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "render/correct/io/archive.h"
#include "render/correct/io/mpcdi.h"
#include "render/correct/io/pfm.h"
#include "render/image/png_levels.h"

namespace merlin::render::correct {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// The third float of a cell is the measurement error: NaN (unknown) for known points, and 1 for
// pixels that show nothing ([MPCDI] 3.6.2).
FloatMap floatMap(const MpcdiOutput& output) {
  FloatMap map{output.width, output.height, {}};
  map.cells.reserve(output.places.size());
  for (const Place& p : output.places) {
    if (std::isnan(p.u) || std::isnan(p.v))
      map.cells.push_back({kNaN, kNaN, 1});
    else
      map.cells.push_back({p.u, 1 - p.v, kNaN});
  }
  return map;
}

// Gamma of alpha maps: with linear values, 1 / 65535 of light would be three steps of an 8-bit
// signal with gamma 2.4. The format defines no gamma for beta maps.
constexpr double kAlphaGamma = 2;

image::Levels levelsOf(const MpcdiOutput& output, const std::vector<float>& shares, double gamma) {
  image::Levels levels{output.width, output.height, 1, {}};
  levels.values.reserve(shares.size());
  for (const float share : shares)
    levels.values.push_back(static_cast<std::uint16_t>(
        std::lround(65535 * std::pow(static_cast<double>(share), 1 / gamma))));
  return levels;
}

// MPCDI scales the range above black by 1 - beta; our ramps need the same range everywhere, so
// alpha is adjusted. If channels have different black levels, the maps use their mean.
void alphaAndBeta(const MpcdiOutput& output, std::vector<float>& alpha, std::vector<float>& beta) {
  const double level = (output.black[0] + output.black[1] + output.black[2]) / 3;
  alpha = output.shares.gain;
  beta = output.shares.black;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    const double lift = level * static_cast<double>(beta[i]);
    beta[i] = static_cast<float>(lift);
    if (!output.measured)
      alpha[i] = static_cast<float>(static_cast<double>(alpha[i]) * (1 - level) / (1 - lift));
  }
}

void addText(pugi::xml_node node, const char* name, const std::string& text) {
  node.append_child(name).text().set(text.c_str());
}

void describeRegion(pugi::xml_node display, const MpcdiOutput& output) {
  pugi::xml_node buffer = display.append_child("buffer");
  pugi::xml_node region = buffer.append_child("region");
  for (pugi::xml_node node : {buffer, region}) node.append_attribute("id") = output.name.c_str();
  for (const auto& [name, value] :
       {std::pair{"x", 0}, std::pair{"y", 0}, std::pair{"xSize", 1}, std::pair{"ySize", 1}})
    region.append_attribute(name) = value;
  for (pugi::xml_node node : {buffer, region}) {
    node.append_attribute("xResolution") = output.width;
    node.append_attribute("yResolution") = output.height;
  }
  pugi::xml_node color = region.append_child("color");
  for (const char* step : {"decode", "encode"}) {
    pugi::xml_node node = color.append_child(step);
    node.append_attribute("type") = "gamma";
    node.append_attribute("gamma") = fmt::format("{}", output.gamma).c_str();
  }
}

// Adds the output's maps to the archive's entries, and their names to the XML.
Result<Ok> addMaps(pugi::xml_node files, const MpcdiOutput& output, std::size_t number,
                   std::vector<std::pair<std::string, std::string>>& entries) {
  pugi::xml_node fileset = files.append_child("fileset");
  fileset.append_attribute("region") = output.name.c_str();
  const std::string warp = fmt::format("warp{}.pfm", number);
  pugi::xml_node geometry = fileset.append_child("geometryWarpFile");
  addText(geometry, "path", warp);
  addText(geometry, "interpolation", "linear");
  entries.emplace_back(warp, pfmBytes(floatMap(output)));
  std::vector<float> alpha, beta;
  alphaAndBeta(output, alpha, beta);
  for (const auto& [kind, shares, gamma] :
       {std::tuple{"alpha", &alpha, kAlphaGamma}, std::tuple{"beta", &beta, 1.0}}) {
    const std::string path = fmt::format("{}{}.png", kind, number);
    pugi::xml_node map = fileset.append_child(fmt::format("{}Map", kind).c_str());
    addText(map, "componentDepth", "1");
    addText(map, "bitDepth", "16");
    addText(map, "gammaEmbedded", fmt::format("{:.1f}", gamma));
    addText(map, "path", path);
    const auto png = image::encodeLevels(levelsOf(output, *shares, gamma));
    if (!png) return png.error();
    entries.emplace_back(path, *png);
  }
  return Ok{};
}

// Pixels more than half a pixel outside the picture show nothing: other readers would repeat the
// picture's edge there, and lift its black.
void leaveOutside(MpcdiOutput& output) {
  const auto beyond = [](float share, int size) {
    const double at = static_cast<double>(share) * size;
    return !(at >= -0.5 && at <= size + 0.5);
  };
  for (std::size_t i = 0; i < output.places.size(); ++i) {
    Place& place = output.places[i];
    if (!beyond(place.u, output.width) && !beyond(place.v, output.height)) continue;
    place = {kNaN, kNaN};
    if (i < output.shares.gain.size()) output.shares.gain[i] = 0;
    if (i < output.shares.black.size()) output.shares.black[i] = 0;
  }
}

}  // namespace

MpcdiOutput mpcdiOutput(const std::string& name, const CorrectionSettings& settings, int width,
                        int height, const MeasuredCorrection* measured, Threads threads) {
  MpcdiOutput output{name, width, height, settings.blend.gamma};
  output.places =
      Warp(settings, width, height, measured ? &measured->warp : nullptr).places(threads);
  output.shares = sharesOf(settings, width, height, output.places, measured);
  output.black = measured ? measured->beta_level : settings.black.level;
  output.measured = measured != nullptr;
  leaveOutside(output);
  return output;
}

Result<std::string> mpcdiBytes(const std::vector<MpcdiOutput>& outputs, const std::string& date) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "utf-8";
  pugi::xml_node root = document.append_child("MPCDI");
  for (const auto& [name, value] :
       {std::pair{"profile", "2d"}, std::pair{"geometry", "2"}, std::pair{"color", "2"},
        std::pair{"date", date.c_str()}, std::pair{"version", "2.0"}})
    root.append_attribute(name) = value;
  pugi::xml_node display = root.append_child("display"), files = root.append_child("files");
  std::vector<std::pair<std::string, std::string>> entries(1);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    describeRegion(display, outputs[i]);
    if (const auto added = addMaps(files, outputs[i], i + 1, entries); !added) return added.error();
  }
  std::ostringstream xml;
  document.save(xml, "  ");
  entries[0] = {"mpcdi.xml", xml.str()};
  return zipBytes(entries);
}

}  // namespace merlin::render::correct
