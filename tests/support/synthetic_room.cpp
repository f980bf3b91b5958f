#include "tests/support/synthetic_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::test {

Lens lensAt(const Eigen::Vector3d& place, const Eigen::Vector3d& target, double roll_deg) {
  const Eigen::Vector3d z = (target - place).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitY()).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  const Eigen::AngleAxisd roll(roll_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitZ());
  Lens lens;
  lens.place = place;
  lens.R_lens_room = roll.toRotationMatrix() * axes.transpose();
  return lens;
}

void Projector::zoom(double margin) {
  Eigen::AlignedBox2d box;
  for (int i = 0; i <= 32; ++i) {
    const double s = i / 32.0;
    for (const auto& [u, v] : {std::pair{s, 0.0}, {s, 1.0}, {0.0, s}, {1.0, s}})
      box.extend(lens.normalised(placeOf(u * width, v * height)));
  }
  const Eigen::Vector2d room(width - 2 * margin, height - 2 * margin);
  lens.focal = (room.array() / box.sizes().array()).minCoeff();
  lens.centre = Eigen::Vector2d(width, height) / 2 - lens.focal * box.center();
}

Eigen::Vector3d Projector::target(const Eigen::Vector2d& pixel) const {
  // point of the uncorrected picture, for which placeOf() gives the place
  Eigen::Vector2d at = pixel;
  for (int i = 0; i < 20; ++i) {
    const auto off = [&](double x, double y) { return lens.pixelOf(placeOf(x, y)); };
    const Eigen::Vector2d here = off(at.x(), at.y());
    Eigen::Matrix2d slope;
    slope << off(at.x() + 1, at.y()) - here, off(at.x(), at.y() + 1) - here;
    at += slope.inverse() * (pixel - here);
  }
  return placeOf(at.x(), at.y());
}

Light Projector::lightOf(int x, int y) const {
  const std::uint8_t* p =
      &signal[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x))];
  const Light s = Light(p[0], p[1], p[2]) / 255.0;
  return full * (black + (1 - black) * s.pow(gamma));
}

Light Projector::lightAt(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d at = lens.pixelOf(point);
  if (at.x() < 0 || at.y() < 0 || at.x() >= width || at.y() >= height) return Light::Zero();
  const double x = std::clamp(at.x() - 0.5, 0.0, width - 1.001);
  const double y = std::clamp(at.y() - 0.5, 0.0, height - 1.001);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double fx = x - column, fy = y - row;
  return (1 - fy) * ((1 - fx) * lightOf(column, row) + fx * lightOf(column + 1, row)) +
         fy * ((1 - fx) * lightOf(column, row + 1) + fx * lightOf(column + 1, row + 1));
}

Photograph::Photograph(const Lens& camera, int width, int height, const std::vector<Panel>& panels,
                       const std::vector<Projector>& projectors, const std::vector<bool>& lit)
    : camera_(camera), width_(width), height_(height) {
  pixels_.reserve(static_cast<std::size_t>(width * height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      pixels_.push_back(seen({x + 0.5, y + 0.5}, panels, projectors, lit));
  }
}

Light Photograph::at(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d pixel = camera_.pixelOf(point);
  const double x = std::clamp(pixel.x() - 0.5, 0.0, width_ - 1.001);
  const double y = std::clamp(pixel.y() - 0.5, 0.0, height_ - 1.001);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double fx = x - column, fy = y - row;
  return (1 - fy) * ((1 - fx) * pixel_(column, row) + fx * pixel_(column + 1, row)) +
         fy * ((1 - fx) * pixel_(column, row + 1) + fx * pixel_(column + 1, row + 1));
}

std::vector<std::uint8_t> Photograph::pixels() const {
  std::vector<std::uint8_t> pixels;
  for (const Light& light : pixels_) {
    for (const double v : (255 * light.min(1.0).pow(1 / 2.2)).eval())
      pixels.push_back(static_cast<std::uint8_t>(std::lround(v)));
    pixels.push_back(255);
  }
  return pixels;
}

Light Photograph::seen(const Eigen::Vector2d& pixel, const std::vector<Panel>& panels,
                       const std::vector<Projector>& projectors,
                       const std::vector<bool>& lit) const {
  const Eigen::Vector3d ray = camera_.rayOf(pixel);
  for (const Panel& panel : panels) {
    const Eigen::Vector3d normal = panel.right.cross(panel.down);
    const Eigen::Vector3d point =
        camera_.place + normal.dot(panel.upper_left - camera_.place) / normal.dot(ray) * ray;
    const Eigen::Vector3d on = point - panel.upper_left;
    const double x = on.dot(panel.right), y = on.dot(panel.down);
    if (x < 0 || y < 0 || x > panel.width || y > panel.height) continue;
    Light sum = Light::Zero();
    for (std::size_t i = 0; i < projectors.size(); ++i) {
      if (lit[i] && projectors[i].panel.upper_left == panel.upper_left)
        sum += projectors[i].lightAt(point);
    }
    return sum;
  }
  return Light::Zero();
}

std::optional<double> findLine(const Photograph& photograph, const Eigen::Vector3d& place,
                               const Eigen::Vector3d& reach) {
  constexpr int kSamples = 64;  // samples on each side
  std::array<double, 2 * kSamples + 1> bright{};
  for (int i = -kSamples; i <= kSamples; ++i) {
    const Light light = photograph.at(place + reach * i / kSamples);
    bright[static_cast<std::size_t>(i + kSamples)] = std::pow(light.mean(), 1 / 2.2);
  }
  const auto [low, high] = std::minmax_element(bright.begin(), bright.end());
  if (*high - *low < 0.02) return std::nullopt;
  const double threshold = *low + 0.2 * (*high - *low);
  double sum = 0, moment = 0;
  for (int i = -kSamples; i <= kSamples; ++i) {
    const double above = std::max(bright[static_cast<std::size_t>(i + kSamples)] - threshold, 0.0);
    sum += above;
    moment += above * i / kSamples;
  }
  return moment / sum;
}

}  // namespace merlin::test
