#include "daemon/page/showing.h"

#include <utility>

namespace merlin::page {

bool ShowingWatch::update(const Showing& showing, Timestamp now) {
  if (showing.content != content_) {
    *this = {};
    content_ = showing.content;
  }
  const auto since = [now](std::optional<Timestamp>& begin, bool holds) {
    if (!holds) begin.reset();
    if (holds && !begin) begin = now;
  };
  since(uncovered_, !showing.covered);
  since(settled_, !showing.covered && showing.full_detail);
  if (kept_ || content_.empty()) return false;
  const bool is_settled = settled_ && now - *settled_ >= kSettled;
  kept_ = is_settled || (uncovered_ && now - *uncovered_ >= kPatience);
  return kept_;
}

}  // namespace merlin::page
