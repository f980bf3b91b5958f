#include "daemon/cli/wall/plan_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "daemon/cli/svg_chart.h"
#include "render/room/geometry.h"

namespace merlin::cli {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using render::room::Screen;

constexpr double kPlanWidth = 960, kPlanMargin = 60, kMostHeight = 620, kPlanTop = 40,
                 kPlanLine = 16;
constexpr double kPanelLabel = 20, kHingeLabel = 34, kHingeArc = 18;
constexpr const char* kTileColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd",
                                        "#ff7f0e", "#17becf", "#8c564b", "#e377c2"};

// Projects a point of the room to the plan: x to the right, z down.
Vector2d fromAbove(const Vector3d& p) { return {p.x(), p.z()}; }

std::vector<Vector3d> cornersOf(const Screen& s) {
  return {s.corner, s.corner + s.across, s.corner + s.across + s.up, s.corner + s.up};
}

struct DrawnTile {
  std::string name;
  std::vector<Vector3d> corners;  // in the room [m]
  double horizontal_deg;
  std::string colour;

  Vector3d middle() const { return (corners[0] + corners[2]) / 2; }
};

std::vector<DrawnTile> wallTiles(const WallPlan& wall) {
  const auto table = render::room::tileTable(wall.tiles, wall.plan);
  const Vector3d eye = render::room::pointOf(wall.room.eye_m);
  std::vector<DrawnTile> drawn;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!table[i].followsWall() || wall.tiles.tiles[i].eye == render::tiles::Eye::kRight) continue;
    DrawnTile tile{table[i].name,
                   {},
                   table[i].horizontal_deg,
                   kTileColours[drawn.size() % std::size(kTileColours)]};
    for (const auto& c :
         render::room::cornersOf(wall.tiles.tiles[i], wall.plan.tiles[i], wall.wall_distance_m))
      tile.corners.push_back(eye + render::room::pointOf(c));
    drawn.push_back(std::move(tile));
  }
  return drawn;
}

// Maps positions in the room [m] to positions in the drawing [px].
class Scale {
 public:
  explicit Scale(const std::vector<Vector3d>& points) {
    Vector2d low(1, 1), high(-1, -1);
    low *= std::numeric_limits<double>::max();
    high *= std::numeric_limits<double>::max();
    for (const Vector3d& p : points) {
      low = low.cwiseMin(fromAbove(p));
      high = high.cwiseMax(fromAbove(p));
    }
    const Vector2d size = (high - low).cwiseMax(0.1);
    pixels_per_m = std::min((kPlanWidth - 2 * kPlanMargin) / size.x(), kMostHeight / size.y());
    height = size.y() * pixels_per_m + 2 * kPlanMargin;
    offset_ = Vector2d(kPlanWidth / 2, kPlanTop + height / 2) - (low + high) / 2 * pixels_per_m;
  }

  Vector2d at(const Vector3d& p) const { return offset_ + pixels_per_m * fromAbove(p); }

  double pixels_per_m = 1;
  double height = 0;  // height of the drawing, without its title [px]

 private:
  Vector2d offset_;
};

double cross(const Vector2d& o, const Vector2d& a, const Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

// Returns the convex hull of the points, by Andrew's monotone chain.
std::vector<Vector2d> convexHull(std::vector<Vector2d> points) {
  std::ranges::sort(points, [](const Vector2d& a, const Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

std::string polygon(const std::vector<Vector2d>& points, const std::string& attributes) {
  std::string list;
  for (const Vector2d& p : points) list += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
  return fmt::format("<polygon points=\"{}\" {}/>\n", list, attributes);
}

std::string line(const Vector2d& a, const Vector2d& b, const std::string& attributes) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", a.x(),
                     a.y(), b.x(), b.y(), attributes);
}

std::string text(const Vector2d& at, const std::string& attributes, const std::string& what) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x(), at.y(), attributes,
                     svgText(what));
}

std::string degrees(double value) { return fmt::format("{:g}°", std::round(value * 10) / 10); }

// Collects labels; labels at nearly the same position become the lines of one label.
class Labels {
 public:
  // `along`: direction of the text, which is turned by 180 degrees if it would be upside down.
  void add(const Vector2d& at, const std::string& what, const Vector2d& along = {1, 0}) {
    Label& label = all_[{std::lround(at.x() / kPlanLine), std::lround(at.y() / kPlanLine)}];
    if (label.lines.empty()) label = {at, readableAngle(along), {}};
    if (std::ranges::find(label.lines, what) == label.lines.end()) label.lines.push_back(what);
  }
  std::string svg(const std::string& attributes) const {
    std::string out;
    for (const auto& [key, label] : all_) {
      const auto& [at, angle_deg, lines] = label;
      const std::string looks = fmt::format("{}transform=\"rotate({:.1f} {:.1f} {:.1f})\" {}",
                                            kLabel, angle_deg, at.x(), at.y(), attributes);
      double y = at.y() - kPlanLine * (static_cast<double>(lines.size()) - 1) / 2 + 4;
      for (const std::string& what : lines) {
        out += text({at.x(), y}, looks, what);
        y += kPlanLine;
      }
    }
    return out;
  }

 private:
  struct Label {
    Vector2d at;
    double angle_deg = 0;
    std::vector<std::string> lines;
  };
  static double readableAngle(const Vector2d& along) {
    const double angle_deg = std::atan2(along.y(), along.x()) * 180 / std::numbers::pi;
    return angle_deg > 90.5 ? angle_deg - 180 : angle_deg < -89.5 ? angle_deg + 180 : angle_deg;
  }
  // A white border around the letters keeps them readable on lines.
  static constexpr const char* kLabel =
      "text-anchor=\"middle\" paint-order=\"stroke\" stroke=\"white\" stroke-width=\"3\" ";

  std::map<std::pair<long, long>, Label> all_;
};

std::vector<Vector2d> drawn(const std::vector<Vector3d>& points, const Scale& scale) {
  std::vector<Vector2d> out;
  for (const Vector3d& p : points) out.push_back(scale.at(p));
  return out;
}

std::string frusta(const std::vector<DrawnTile>& tiles, const Vector2d& eye, const Scale& scale,
                   Labels& labels) {
  std::string out;
  for (const DrawnTile& tile : tiles) {
    auto points = drawn(tile.corners, scale);
    points.push_back(eye);
    out += polygon(convexHull(std::move(points)),
                   fmt::format("fill=\"{0}\" fill-opacity=\"0.1\" stroke=\"{0}\" "
                               "stroke-width=\"0.7\"",
                               tile.colour));
    constexpr double kAlong = 0.7;
    const Vector2d at = eye + kAlong * (scale.at(tile.middle()) - eye);
    labels.add(at, tile.name + " " + degrees(tile.horizontal_deg));
  }
  return out;
}

// Draws the pictures of the tiles in front of their panels, alternately at two distances, so that
// overlaps can be seen.
std::string pictures(const std::vector<DrawnTile>& tiles, const Scale& scale) {
  std::string out;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto& at = tiles[i].corners;
    const Vector2d towards = fromAbove((at[1] - at[0]).cross(at[3] - at[0]).normalized());
    auto points = drawn(at, scale);
    for (Vector2d& p : points) p += (i % 2 == 0 ? 5 : 9) * towards;
    out += polygon(points, fmt::format("fill=\"{0}\" fill-opacity=\"0.15\" stroke=\"{0}\" "
                                       "stroke-width=\"3\"",
                                       tiles[i].colour));
  }
  return out;
}

// Returns the angle between the panels on the viewer's side [degrees] if `b` is hinged to the right
// edge of `a`; otherwise 0.
double hingeOf(const Screen& a, const Screen& b) {
  constexpr double kSame_m = 0.005;
  const Vector3d right = a.corner + a.across;
  if ((right - b.corner).norm() > kSame_m || a.up.normalized().dot(b.up.normalized()) < 0.999)
    return 0;
  const Vector3d from = a.across.normalized(), to = b.across.normalized();
  const double turn = std::atan2(a.up.normalized().dot(from.cross(to)), from.dot(to));
  return 180 + turn * 180 / std::numbers::pi;
}

std::string hinge(const Screen& a, const Screen& b, double hinge_deg, const Scale& scale,
                  Labels& labels) {
  const Vector2d at = scale.at(b.corner);
  const Vector2d side = fromAbove(a.normal() + b.normal());
  if (side.norm() < 1e-6) return {};
  labels.add(at + kHingeLabel * side.normalized(), degrees(hinge_deg));
  const Vector2d from = at - kHingeArc * fromAbove(a.across).normalized();
  const Vector2d to = at + kHingeArc * fromAbove(b.across).normalized();
  return fmt::format(
      "<path d=\"M {:.1f} {:.1f} A {} {} 0 {} 0 {:.1f} {:.1f}\" fill=\"none\" stroke=\"#444\"/>\n",
      from.x(), from.y(), kHingeArc, kHingeArc, hinge_deg > 180 ? 1 : 0, to.x(), to.y());
}

std::string panels(const WallPlan& wall, const std::vector<Screen>& screens, const Scale& scale) {
  std::string out;
  Labels names, hinges;
  for (std::size_t i = 0; i < screens.size(); ++i) {
    const Screen& s = screens[i];
    out += polygon(drawn(cornersOf(s), scale),
                   "fill=\"#888\" fill-opacity=\"0.15\" stroke=\"#555\" stroke-width=\"4\" "
                   "stroke-linejoin=\"round\"");
    names.add(scale.at(s.middle()) - kPanelLabel * fromAbove(s.normal()),
              fmt::format("{} {:g} x {:g} m", wall.room.panels[i].name, wall.room.panels[i].width_m,
                          wall.room.panels[i].height_m),
              fromAbove(s.across));
    for (const Screen& next : screens) {
      const double angle = hingeOf(s, next);
      if (angle > 0) out += hinge(s, next, angle, scale, hinges);
    }
  }
  return out + names.svg("fill=\"#555\"") + hinges.svg("fill=\"#444\" font-size=\"11\"");
}

std::string viewer(const WallPlan& wall, const Vector2d& eye) {
  const Vector2d ahead = eye - Vector2d(0, 26);
  std::string out =
      line(eye, ahead, "stroke=\"black\"") +
      polygon({ahead - Vector2d(0, 6), ahead + Vector2d(4, 3), ahead + Vector2d(-4, 3)},
              "fill=\"black\"");
  out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"black\"/>\n", eye.x(),
                     eye.y());
  const auto& at = wall.room.eye_m;
  Labels label;
  label.add(eye + Vector2d(0, 18),
            wall.room.panels.empty() ? std::string("eye")
                                     : fmt::format("eye {:g}, {:g}, {:g} m", at[0], at[1], at[2]));
  return out + label.svg("");
}

// Draws a scale bar with a length of 1, 2 or 5 times a power of ten metres.
std::string scaleBar(const Scale& scale) {
  double metres = 0.001;
  for (const double factor : {1.0, 2.0, 5.0}) {
    for (int power = -3; power <= 4; ++power) {
      const double length = factor * std::pow(10.0, power);
      if (length * scale.pixels_per_m <= 180) metres = std::max(metres, length);
    }
  }
  const Vector2d from(20, kPlanTop + scale.height - 12);
  const Vector2d to = from + Vector2d(metres * scale.pixels_per_m, 0), tick(0, 5);
  const std::string stroke = "stroke=\"black\"";
  return line(from, to, stroke) + line(from - tick, from + tick, stroke) +
         line(to - tick, to + tick, stroke) +
         text((from + to) / 2 - Vector2d(0, 6), "text-anchor=\"middle\"",
              fmt::format("{:g} m", metres));
}

// Cells of one line of the table; empty cells at the end are not printed.
using Cells = std::array<std::string, 9>;

std::string lineOf(const Cells& cells) {
  constexpr std::array<int, 9> kWidths = {17, 10, 13, 13, 15, 17, 15, 15, 12};
  std::string out;
  for (std::size_t i = 0; i < cells.size(); ++i) out += fmt::format("{:<{}}", cells[i], kWidths[i]);
  out.erase(out.find_last_not_of(' ') + 1);
  return out;
}

Cells cellsOf(const render::room::TileFigures& f) {
  Cells cells = {
      f.name, f.shows(), fmt::format("{} x {}", f.width, f.height), fmt::format("{}, {}", f.x, f.y),
      f.horizontal_deg > 0 ? fmt::format("{:.2f} x {:.2f}", f.horizontal_deg, f.vertical_deg)
                           : "parallel"};
  if (f.followsWall()) cells[5] = fmt::format("{:.2f}, {:.2f}", f.yaw_deg, f.pitch_deg);
  if (!f.screen) return cells;
  cells[6] = fmt::format("{:.3f} x {:.3f}", f.screen->width_m, f.screen->height_m);
  cells[7] =
      fmt::format("{:.3f} x {:.3f}", f.screen->pixel_pitch_mm[0], f.screen->pixel_pitch_mm[1]);
  cells[8] = fmt::format("{:.3f}", f.screen->distance_m);
  return cells;
}

}  // namespace

std::vector<std::string> tableLines(const WallPlan& wall) {
  std::vector<std::string> lines = {
      lineOf({"tile", "kind", "pixels", "in frame", "view [deg]", "direction [deg]", "picture [m]",
              "pixel [mm]", "distance [m]"})};
  for (const render::room::TileFigures& f : render::room::tileTable(wall.tiles, wall.plan))
    lines.push_back(lineOf(cellsOf(f)));
  lines.push_back(
      fmt::format("The frame has {} x {} pixels.", wall.plan.frame_width, wall.plan.frame_height));
  for (const render::room::TileOverlap& o : render::room::tileOverlaps(wall.plan)) {
    lines.push_back(
        fmt::format("{} and {} overlap by {:.3f} x {:.3f} m: {} x {} pixels of {}, {} x {} of {}.",
                    o.left, o.right, o.width_m, o.height_m, o.left_px[0], o.left_px[1], o.left,
                    o.right_px[0], o.right_px[1], o.right));
  }
  return lines;
}

std::string planSvg(const WallPlan& wall) {
  const auto screens = render::room::panelScreens(wall.room);
  const auto tiles = wallTiles(wall);
  std::vector<Vector3d> points = {render::room::pointOf(wall.room.eye_m)};
  for (const Screen& s : screens) std::ranges::copy(cornersOf(s), std::back_inserter(points));
  for (const DrawnTile& t : tiles) std::ranges::copy(t.corners, std::back_inserter(points));
  const Scale scale(points);
  const Vector2d eye = scale.at(points.front());
  const auto lines = tableLines(wall);
  double y = kPlanTop + scale.height + 24;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n",
      kPlanWidth, y + kPlanLine * static_cast<double>(lines.size()) + 10);
  out += text({20, 26}, "font-size=\"16\"", "The wall from above");
  Labels labels;
  out += frusta(tiles, eye, scale, labels);
  out += panels(wall, screens, scale);
  out += pictures(tiles, scale);
  out += labels.svg("fill=\"#222\"") + viewer(wall, eye) + scaleBar(scale);
  for (const std::string& each : lines) {
    out += text({20, y}, "font-family=\"monospace\" font-size=\"12\" xml:space=\"preserve\"", each);
    y += kPlanLine;
  }
  return out + "</svg>\n";
}

}  // namespace merlin::cli
