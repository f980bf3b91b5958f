// ShowingWatch: decides when the wall's picture is suitable as the thumbnail of the content that it
// shows. Pure.
#pragma once

#include <optional>
#include <string>

#include "daemon/base/clock.h"

namespace merlin::page {

// What the wall shows.
struct Showing {
  std::string content;       // its name
  bool covered = false;      // the picture is black, frozen or dimmed, or a test card hides it
  bool full_detail = false;  // the wall shows full detail and stands still

  bool operator==(const Showing&) const = default;
};

// Thread-bound.
class ShowingWatch {
 public:
  // Returns whether the picture is now to be kept as the content's thumbnail. This happens once
  // each time that the content is shown, when it has been at full detail for kSettled or uncovered
  // for kPatience. To be called several times a second.
  bool update(const Showing& showing, Timestamp now);

  static constexpr Duration kSettled = std::chrono::milliseconds(700);
  static constexpr Duration kPatience = std::chrono::seconds(4);

 private:
  std::string content_;
  bool kept_ = false;
  std::optional<Timestamp> uncovered_, settled_;  // since when it has been so
};

}  // namespace merlin::page
