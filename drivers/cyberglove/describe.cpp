// The description of a CyberGlove's settings.
#include "daemon/base/settings_visitor.h"
#include "drivers/cyberglove/settings.h"

namespace merlin {
namespace {

constexpr const char* kSlot7Rules[] = {"zero", "neutral", "derived", "switch"};
constexpr const char* kDialogues[] = {"binary", "text"};
constexpr const char* kWristLights[] = {"switch", "off", "on"};

}  // namespace

void describe(CybergloveSettings& glove, SettingsVisitor& v) {
  v.numbers(
      "offset", glove.offset, {-10000, 10000},
      "Raw sensor value at a joint angle of 0 rad, for each of the 23 sensor slots, 0 to 22.");
  v.numbers("gain", glove.gain, {-1, 1},
            "Change of the joint angle per raw count, in radians, for each of the 23 sensor slots, "
            "0 to 22; negative for a sensor that is mounted the other way round.");
  v.oneOf("slot7", glove.slot7, kSlot7Rules,
          "Value of sensor slot 7, the abduction of the index finger, which no known glove "
          "measures. zero: 0; neutral: the angle at the middle of the raw range; derived: the mean "
          "of slots 3 and 11, the abductions beside it; switch: the wrist switch (1 on, 0 off).");
  v.number("rate_hz", glove.rate_hz, {1, 150},
           "Records per second that merlind requests from the glove.");
  v.oneOf("dialogue", glove.dialogue, kDialogues,
          "Format of the glove's records and commands: binary, or text (decimal numbers), which "
          "takes four times as long to transmit.");
  v.oneOf("light", glove.light, kWristLights,
          "Light on the glove's wrist. switch: the light shows the state of the wrist switch; off "
          "or on: the light is always off or always on.");
  v.flag("time_stamps", glove.time_stamps,
         "Whether the glove's interface unit adds a time stamp to each record. Time stamps show "
         "which records were lost on the line, so that the sample counter can include them.");
  v.flag("filter", glove.filter,
         "Whether the low-pass filter in the glove's interface unit is on.");
}

}  // namespace merlin
