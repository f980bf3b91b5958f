#include "daemon/base/did_you_mean.h"

#include <algorithm>
#include <numeric>

namespace merlin {
namespace {

constexpr std::size_t kLongest = 64;

// Optimal string alignment distance: F. J. Damerau, "A technique for computer detection and
// correction of spelling errors", 1964, restricted so that no part is edited twice.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearestWord(std::string_view word, const std::vector<std::string>& known) {
  if (word.size() > kLongest) return {};
  std::size_t best = std::max<std::size_t>(word.size() / 2, 1) + 1;
  std::string found;
  for (const std::string& candidate : known) {
    const std::size_t d = distance(word, candidate);
    if (d >= best) continue;
    best = d;
    found = candidate;
  }
  return found;
}

}  // namespace merlin
