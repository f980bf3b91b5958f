#include "drivers/vrpn/device.h"

#include <algorithm>
#include <cmath>

#include "drivers/port/plausible.h"
#include "drivers/vrpn/identity.h"

namespace merlin::vrpn {
namespace {

constexpr Duration kPoseTime = std::chrono::seconds(2);  // time without a pose until a complaint
constexpr const char* kTypes[] = {kVrpnPoseType};

constexpr const char* kNoneCame = "the server has the device, but no pose of it comes";
constexpr const char* kLeft = "the server no longer has the device";
constexpr const char* kOtherSensors =
    "poses come only from sensors that \"stations\" does not name";
constexpr const char* kTooFar = "poses come from beyond 25 m: is \"scale\" right?";
constexpr const char* kNoNumbers = "poses come with values that are not numbers";
constexpr const char* kNoRotation = "the orientations that come are not unit quaternions";

// Explains why the sample is implausible.
const char* faultOf(const TrackerSample& sample) noexcept {
  const auto& p = sample.position_m;
  const auto& q = sample.orientation_wxyz;
  const auto isNumber = [](float v) { return std::isfinite(v); };
  if (!std::all_of(std::begin(p), std::end(p), isNumber) ||
      !std::all_of(std::begin(q), std::end(q), isNumber))
    return kNoNumbers;
  const bool near =
      std::all_of(std::begin(p), std::end(p), [](float v) { return std::abs(v) <= kFurthest_m; });
  return near ? kNoRotation : kTooFar;
}

void normalise(float (&q)[4]) noexcept {
  const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (float& v : q) v /= norm;
}

}  // namespace

VrpnDevice::VrpnDevice(const VrpnSettings& settings, const Clock& clock, SampleSink& sink)
    : settings_(settings),
      clock_(clock),
      sink_(sink),
      client_(settings.device, kTypes, clock, *this) {
  for (std::size_t i = 0; i < kStations; ++i) {
    sample_[i].station = static_cast<std::uint32_t>(i + 1);
    sample_[i].error = ' ';
  }
}

Result<std::string> VrpnDevice::open(ByteStream& stream) {
  posed_ = clock_.now();
  silence_ = kNoneCame;
  complaint_ = "";
  const std::uint64_t before = samples_;
  const auto version = client_.open(stream, [&] { return samples_ == before ? silence_ : ""; });
  if (!version) return version.error();
  return trackerIdentity(settings_.device, *version);
}

Result<Ok> VrpnDevice::poll(ByteStream& stream) {
  const auto polled = client_.poll(stream);
  if (!polled) return polled;
  const char* const silence = clock_.now() - posed_ < kPoseTime ? "" : silence_;
  complaint_ = client_.knowsDevice() ? silence : kLeft;
  return polled;
}

bool VrpnDevice::take(std::size_t, std::string_view payload, Timestamp first_byte) noexcept {
  const auto pose = readVrpnPose(payload);
  return pose && pose->sensor >= 0 && publish(*pose, first_byte);
}

// Returns false if the pose is implausible; a sensor that is not used as a station is no fault.
bool VrpnDevice::publish(const VrpnPose& pose, Timestamp first_byte) noexcept {
  const auto& stations = settings_.stations;
  const auto station = std::find(stations.begin(), stations.end(), pose.sensor);
  if (station == stations.end()) {
    silence_ = kOtherSensors;
    return true;
  }
  TrackerSample& newest = sample_[static_cast<std::size_t>(station - stations.begin())];
  TrackerSample sample = newest;
  for (std::size_t i = 0; i < 3; ++i)
    sample.position_m[i] = static_cast<float>(settings_.scale * pose.position[i]);
  for (std::size_t i = 0; i < 4; ++i)
    sample.orientation_wxyz[i] = static_cast<float>(pose.orientation_wxyz[i]);
  if (!plausible(sample)) {
    silence_ = faultOf(sample);
    return false;
  }
  normalise(sample.orientation_wxyz);
  place(settings_.placement, sample);
  if (!plausible(sample)) {
    silence_ = kPlacedTooFar;
    return false;
  }
  sample.received_ns = toNanoseconds(first_byte);
  ++sample.counter;
  newest = sample;
  ++samples_;
  posed_ = clock_.now();
  silence_ = kNoneCame;
  sink_.publish(sample);
  return true;
}

std::unique_ptr<Device> makeDevice(const VrpnSettings& settings, const Clock& clock,
                                   SampleSink& sink) {
  return std::make_unique<VrpnDevice>(settings, clock, sink);
}

}  // namespace merlin::vrpn
