// The description of a Fastrak's settings.
#include <fmt/format.h>

#include "daemon/base/settings_visitor.h"
#include "drivers/fastrak/settings.h"

namespace merlin {
namespace {

constexpr const char* kTrackerNumbers[] = {"binary", "text", "short"};

void describeForm(FastrakSettings& t, SettingsVisitor& v) {
  constexpr const char* kAlignments[] = {"alignment1_cm", "alignment2_cm", "alignment3_cm",
                                         "alignment4_cm"};
  constexpr const char* kBoresights[] = {"boresight1_wxyz", "boresight2_wxyz", "boresight3_wxyz",
                                         "boresight4_wxyz"};
  for (std::size_t i = 0; i < 4; ++i) {
    v.numbers(kAlignments[i], t.alignment_cm[i], {-1000, 1000},
              "Alignment of the station whose number is in the key: the frame in which its "
              "positions are reported, as three points x, y, z in the transmitter's frame, in "
              "centimetres: the new origin, a point on the new x axis, a point on the new y axis.");
    v.numbers(kBoresights[i], t.boresight_wxyz[i], {-1, 1},
              "Boresight of the station whose number is in the key: the orientation of its "
              "receiver that counts as straight ahead, as a unit quaternion w, x, y, z in the "
              "frame that the station's alignment sets.");
  }
  v.numbers("position_filter", t.position_filter, {0, 1},
            "Adaptive low-pass filter for positions inside the tracker, as four numbers: "
            "sensitivity of the filter to motion; smallest filter coefficient, used at rest (the "
            "smaller, the smoother); largest filter coefficient, used in fast motion; factor that "
            "limits how fast the coefficient falls when a motion ends. If the second and third "
            "number are both 1, the filter is off.");
  v.numbers("angle_filter", t.angle_filter, {0, 1},
            "Adaptive low-pass filter for orientations inside the tracker, as four numbers: "
            "sensitivity of the filter to motion; smallest filter coefficient, used at rest (the "
            "smaller, the smoother); largest filter coefficient, used in fast motion; factor that "
            "limits how fast the coefficient falls when a motion ends. If the second and third "
            "number are both 1, the filter is off.");
  v.oneOf("numbers", t.numbers, kTrackerNumbers,
          "Format of numbers on the serial line: binary (floating-point numbers), text (decimal "
          "numbers) or short (14-bit integers, which only units made before 2012 support).");
  v.flag("angles", t.angles,
         "Whether the tracker sends orientations as azimuth, elevation and roll instead of "
         "quaternions. Samples contain quaternions either way.");
  v.flag("stylus", t.stylus,
         "Whether station 1 is a stylus; if so, each of its records contains the state of the "
         "stylus button.");
  v.numbers("stylus_tip_cm", t.stylus_tip_cm, {-100, 100},
            "Position of the stylus tip relative to the receiver coil in the stylus: x, y, z in "
            "centimetres.");
}

}  // namespace

void describe(FastrakSettings& t, SettingsVisitor& v) {
  constexpr const char* kKeys[] = {"hemisphere1", "hemisphere2", "hemisphere3", "hemisphere4"};
  for (std::size_t i = 0; i < t.hemisphere.size(); ++i) {
    v.numbers(
        kKeys[i], t.hemisphere[i], {-1, 1},
        fmt::format("Hemisphere of operation of station {}: a vector in the transmitter's frame "
                    "that points into the half-space that contains the receiver. 0, 0, 0: the "
                    "tracker detects when the receiver crosses into the other half-space.",
                    i + 1)
            .c_str());
  }
  describeForm(t, v);
  v.flag("centimetres", t.centimetres,
         "Unit of positions on the serial line: true for centimetres, false for inches. Samples "
         "are in metres either way.");
}

}  // namespace merlin
