// Statistics over many measurements, for the benchmarks.
#pragma once

#include <algorithm>
#include <vector>

namespace merlin::test {

// The quantile at `share` (0..1), without interpolation; 0 if `values` is empty.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace merlin::test
