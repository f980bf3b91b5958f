// The description of the settings of a tracker whose poses come as OSC messages.
#include "daemon/base/settings_visitor.h"
#include "drivers/osc/settings.h"

namespace merlin {

void describe(OscSettings& o, SettingsVisitor& v) {
  constexpr const char* kOrders[] = {"xyzw", "wxyz"};
  v.text("address", o.address,
         "Address of the OSC messages with the poses; {station} in it stands for the station's "
         "name. Without {station}, the first argument of a message is the station's name or "
         "number; if that is missing too, all messages are of the first station. The other "
         "arguments are seven numbers, position x y z and the orientation's quaternion, or three, "
         "the position alone.");
  v.texts("stations", o.stations,
          "The sender's name or number of station 1, 2, 3 and 4; \"\" for a station that is not "
          "used.");
  v.oneOf("quaternion", o.quaternion, kOrders,
          "Order in which the quaternion's components are sent: the real part w last or first.");
  v.number("scale", o.scale, {1e-6, 1e3},
           "Metres in the sender's unit of length: 1 for metres, 0.001 for millimetres.");
  describe(o.placement, v);
}

}  // namespace merlin
