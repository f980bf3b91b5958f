// ShowingWatch: decides when the wall's picture shows a content as people know it. Pure.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/clock.h"

namespace merlin::page {

// What the wall shows.
struct Showing {
  std::string content;       // its name
  bool covered = false;      // it is black, frozen, dimmed, or a test card hides it
  bool full_detail = false;  // and stands still

  bool operator==(const Showing&) const = default;
};

// Thread-bound.
class ShowingWatch {
 public:
  // Whether the picture is to be kept as that of the content: once each time that it comes up, when
  // it has been at full detail for kSettled, or uncovered for kPatience. To be called several times
  // a second.
  bool update(const Showing& showing, Timestamp now);

  static constexpr Duration kSettled = std::chrono::milliseconds(700);
  static constexpr Duration kPatience = std::chrono::seconds(4);

 private:
  std::string content_;
  bool kept_ = false;
  std::optional<Timestamp> uncovered_, settled_;  // since when
};

}  // namespace merlin::page
