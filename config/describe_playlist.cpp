#include "config/describe_playlist.h"

namespace merlin {

void describePlaylist(PlaylistSettings& p, SettingsVisitor& v) {
  constexpr Range kADay{0, 86'400};
  v.number(
      "after_s", p.after_s, kADay,
      "Time in seconds without input (from a ball, hand, button, touch surface, mouse or command) "
      "after which the playlist begins. 0: only the command `merlin playlist on` begins it.");
  v.number("hold_s", p.hold_s, {1, 86'400},
           "Time in seconds for which the playlist shows each content, and each slide.");
  v.number("turn_deg_per_s", p.turn_deg_per_s, {-90, 90},
           "Angular speed, in degrees per second, at which the playlist turns a model about the "
           "vertical axis (its front moves to the right) and the view of a panorama (to the "
           "right); negative: to the left. Pictures and slides stand still. 0: nothing turns.");
  v.texts("contents", p.contents,
          "Names of the contents that the playlist shows, in this order. Empty: all contents of "
          "the configuration.");
  v.number("dim_after_s", p.dim_after_s, kADay,
           "Time in seconds without input after which the picture is dimmed, whether the playlist "
           "has begun or not. 0: never.");
  v.number("dim_to", p.dim_to, {0, 1},
           "Light of a dimmed picture, as a share of the full light, for outputs of gamma 2.2.");
}

}  // namespace merlin
