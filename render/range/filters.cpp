#include "render/range/filters.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "daemon/base/huge_vector.h"

namespace merlin::render::range {
namespace {

void order(float& a, float& b) {
  const float low = std::min(a, b);
  b = std::max(a, b);
  a = low;
}

// Returns the median of nine values by a partial odd-even sort: it sorts each column, then finds
// the largest of the low values, the median of the middle ones, and the smallest of the high ones;
// the result is the median of these three.
float medianOfNine(std::array<float, 9> v) {
  for (std::size_t i = 0; i < 9; i += 3) {
    order(v[i + 1], v[i + 2]);
    order(v[i], v[i + 1]);
    order(v[i + 1], v[i + 2]);
  }
  const float low = std::max(v[0], std::max(v[3], v[6]));
  const float high = std::min(v[2], std::min(v[5], v[8]));
  order(v[1], v[4]);
  const float middle = std::max(v[1], std::min(v[4], v[7]));
  float a = low, b = middle;
  order(a, b);
  return std::max(a, std::min(b, high));
}

std::vector<float> copyOf(const std::vector<float>& ranges) {
  std::vector<float> copy;
  resizeHuge(copy, ranges.size());
  std::copy(ranges.begin(), ranges.end(), copy.begin());
  return copy;
}

// Access to the pixels around a pixel. In a full turn, the first and the last column are
// neighbours.
class Neighbourhood {
 public:
  Neighbourhood(const RangeImage& image, const std::vector<float>& ranges)
      : width_(static_cast<std::ptrdiff_t>(image.width)),
        height_(static_cast<std::ptrdiff_t>(image.height)),
        wraps_(image.wraps()),
        ranges_(ranges.data()) {}

  // Returns whether all pixels up to `reach` away are in the image.
  bool isInside(std::ptrdiff_t row, std::ptrdiff_t column, std::ptrdiff_t reach) const {
    return row >= reach && column >= reach && row + reach < height_ && column + reach < width_;
  }
  // Returns the range at a pixel; kNoReturn (NaN) outside the image.
  float at(std::ptrdiff_t row, std::ptrdiff_t column) const {
    if (row < 0 || row >= height_) return kNoReturn;
    if (wraps_) column = (column + width_) % width_;
    return column < 0 || column >= width_ ? kNoReturn : ranges_[row * width_ + column];
  }
  const float* pixel(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return ranges_ + row * width_ + column;
  }
  std::ptrdiff_t width() const { return width_; }

 private:
  std::ptrdiff_t width_, height_;
  bool wraps_;
  const float* ranges_;
};

float medianAt(const Neighbourhood& around, std::ptrdiff_t row, std::ptrdiff_t column,
               std::ptrdiff_t reach) {
  std::array<float, 15 * 15> values{};
  std::size_t n = 0;
  for (std::ptrdiff_t y = row - reach; y <= row + reach; ++y) {
    for (std::ptrdiff_t x = column - reach; x <= column + reach; ++x) {
      const float value = around.at(y, x);
      if (isReturn(value)) values[n++] = value;
    }
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((n - 1) / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(n));
  return *middle;
}

// Sets `nine` to the 3 x 3 pixels around a pixel, row by row; returns whether all are returns.
bool nineAt(const Neighbourhood& around, std::ptrdiff_t row, std::ptrdiff_t column,
            std::array<float, 9>& nine) {
  const float* p = around.pixel(row - 1, column - 1);
  float sum = 0;
  for (std::size_t i = 0; i < 3; ++i, p += around.width()) {
    for (std::size_t k = 0; k < 3; ++k) sum += nine[3 * i + k] = p[k];
  }
  return isReturn(sum);
}

// Returns the number of neighbours whose range differs from that of the pixel by at most the limit;
// stops counting at two.
int agreeing(const Neighbourhood& around, std::ptrdiff_t row, std::ptrdiff_t column,
             const Threshold& limit) {
  const float range = *around.pixel(row, column);
  int count = 0;
  for (std::ptrdiff_t i = 0; i < 9 && count < 2; ++i) {
    const float other = around.at(row + i / 3 - 1, column + i % 3 - 1);
    const float nearest = std::min(std::abs(range), std::abs(other));
    count += i != 4 && std::abs(other - range) <= limit.at(nearest);  // false for NaN
  }
  return count;
}

}  // namespace

void medianFilter(RangeImage& image, std::size_t window, const Work& work) {
  assert(window % 2 == 1 && window >= 3 && window <= 15);
  const std::vector<float> before = copyOf(image.range);
  const Neighbourhood around(image, before);
  const auto reach = static_cast<std::ptrdiff_t>(window / 2);
  forRows(work, image.height, [&](std::size_t r) {
    const auto row = static_cast<std::ptrdiff_t>(r);
    std::array<float, 9> nine{};
    for (std::size_t c = 0; c < image.width; ++c) {
      float& range = image.range[r * image.width + c];
      const auto column = static_cast<std::ptrdiff_t>(c);
      if (!isReturn(range)) continue;
      const bool fast =
          reach == 1 && around.isInside(row, column, 1) && nineAt(around, row, column, nine);
      range = fast ? medianOfNine(nine) : medianAt(around, row, column, reach);
    }
  });
}

std::size_t removeSpikes(RangeImage& image, const Threshold& limit, const Work& work) {
  const std::vector<float> before = copyOf(image.range);
  const Neighbourhood around(image, before);
  std::vector<std::size_t> removed(image.height, 0);
  forRows(work, image.height, [&](std::size_t r) {
    for (std::size_t c = 0; c < image.width; ++c) {
      float& range = image.range[r * image.width + c];
      if (!isReturn(range)) continue;
      const auto row = static_cast<std::ptrdiff_t>(r), column = static_cast<std::ptrdiff_t>(c);
      if (agreeing(around, row, column, limit) >= 2) continue;
      range = kNoReturn;
      ++removed[r];
    }
  });
  std::size_t all = 0;
  for (const std::size_t n : removed) all += n;
  return all;
}

std::size_t removeOutside(RangeImage& image, float nearest, float farthest) {
  std::size_t removed = 0;
  for (float& range : image.range) {
    if (!isReturn(range) || (range >= nearest && range <= farthest)) continue;
    range = kNoReturn;
    ++removed;
  }
  return removed;
}

}  // namespace merlin::render::range
