#include "daemon/cli/mesh/about_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "daemon/base/words.h"
#include "render/range/colours.h"

namespace merlin::cli {

std::string valueIn(std::string_view about, const std::string& key) {
  while (!about.empty()) {
    const std::string_view line = takeLine(about);
    if (line.starts_with(key + "=")) return std::string(line.substr(key.size() + 1));
  }
  return {};
}

std::string aboutOrigin(const render::mesh::Origin& origin) {
  if (origin == render::mesh::Origin{}) return {};
  return fmt::format("mesh.origin={} {} {}\n", origin[0], origin[1], origin[2]);
}

render::mesh::Origin originIn(std::string_view about) {
  std::string text = valueIn(about, "mesh.origin");
  if (text.empty()) text = valueIn(about, "points.origin");
  std::string_view words = text;
  render::mesh::Origin origin{};
  for (double& x : origin) {
    if (!readNumber(takeWord(words), x) || !std::isfinite(x)) return {};
  }
  return origin;
}

std::string aboutFeatures(const std::vector<FeatureFacts>& features) {
  std::string text;
  for (const FeatureFacts& f : features) {
    if (f.dimension != 1) continue;
    if (!f.unit.empty()) text += fmt::format("feature.{}.unit={}\n", f.name, f.unit);
    text += fmt::format("feature.{}.range={} {}\n", f.name, f.low, f.high);
  }
  return text;
}

FeatureFacts featureIn(std::string_view about, const std::string& name) {
  FeatureFacts facts{name, valueIn(about, fmt::format("feature.{}.unit", name))};
  const std::string range = valueIn(about, fmt::format("feature.{}.range", name));
  std::string_view words = range;
  float low = 0, high = 0;
  const bool read = readNumber(takeWord(words), low) && readNumber(takeWord(words), high);
  if (!read || !std::isfinite(low) || !std::isfinite(high) || !(low < high)) return facts;
  facts.low = low;
  facts.high = high;
  return facts;
}

FeatureFacts factsOf(const render::range::Plane& plane, const render::range::RangeImage& image) {
  FeatureFacts facts{plane.name, plane.unit, plane.dimension, plane.low, plane.high};
  if (facts.low != facts.high || facts.dimension != 1) return facts;
  std::vector<float> values;  // values of the plane at pixels with a return
  for (std::size_t p = 0; p < image.pixels(); ++p) {
    if (render::range::isReturn(image.range[p])) values.push_back(plane.values[p]);
  }
  const render::range::Ends ends = render::range::endsOf(values);
  facts.low = ends.low;
  facts.high = ends.high;
  return facts;
}

FeatureFacts joined(const std::vector<FeatureFacts>& same_name, bool& differ) {
  FeatureFacts all = same_name.front();
  differ = false;
  for (const FeatureFacts& f : same_name) {
    if (all.unit.empty()) all.unit = f.unit;
    differ = differ || (!f.unit.empty() && f.unit != all.unit);
    all.low = std::min(all.low, f.low);
    all.high = std::max(all.high, f.high);
  }
  if (differ) all.unit.clear();
  return all;
}

}  // namespace merlin::cli
