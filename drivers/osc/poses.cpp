#include "drivers/osc/poses.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "daemon/base/printable_text.h"
#include "drivers/port/plausible.h"

namespace merlin::osc {
namespace {

constexpr std::size_t kPosition = 3, kPose = 7;  // numbers in a message

constexpr const char* kOtherAddress = "OSC messages come, but none to the address of a station";
constexpr const char* kOtherStation =
    "poses come only from stations that \"stations\" does not name";
constexpr const char* kNotFormed = "messages of poses have neither 3 nor 7 numbers";
constexpr const char* kTooFar = "poses come from beyond 25 m: is \"scale\" right?";
constexpr const char* kNoNumbers = "poses come with values that are not numbers";
constexpr const char* kNoRotation = "the orientations that come are not unit quaternions";

bool isNumber(const OscArgument& argument) noexcept {
  return argument.kind == OscArgument::kReal || argument.kind == OscArgument::kInteger;
}

// Returns whether an argument equals this name: it is a text, or a whole number whose digits are
// the name. The number may be an integer or a real, because some senders use one type for all
// numbers.
bool names(const OscArgument& argument, std::string_view name) noexcept {
  if (argument.kind == OscArgument::kText) return argument.text == name;
  if (!isNumber(argument)) return false;
  std::int32_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, number);
  return error == std::errc() && stop == end && number == argument.number;
}

void normalise(float (&q)[4]) noexcept {
  const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (float& v : q) v /= norm;
}

// Explains why the sample is implausible.
const char* faultOf(const TrackerSample& sample) noexcept {
  const auto isFinite = [](float v) { return std::isfinite(v); };
  const auto isNear = [](float v) { return std::abs(v) <= kFurthest_m; };
  if (!std::ranges::all_of(sample.position_m, isFinite) ||
      !std::ranges::all_of(sample.orientation_wxyz, isFinite))
    return kNoNumbers;
  return std::ranges::all_of(sample.position_m, isNear) ? kNoRotation : kTooFar;
}

}  // namespace

Poses::Poses(const OscSettings& settings, SampleSink& sink) : settings_(settings), sink_(sink) {
  const std::string_view place = OscSettings::kStation;
  const std::size_t at = settings.address.find(place);
  named_by_address_ = at != std::string::npos;
  for (std::size_t i = 0; i < std::min(stations_.size(), settings.stations.size()); ++i) {
    const std::string& name = settings.stations[i];
    std::string address = settings.address;
    if (named_by_address_) address.replace(at, place.size(), name);
    stations_[i] = {!name.empty(), name, std::move(address)};
  }
  for (std::size_t i = 0; i < kStations; ++i) {
    sample_[i].station = static_cast<std::uint32_t>(i + 1);
    sample_[i].error = ' ';
  }
}

std::string Poses::expected() const {
  const auto first = std::ranges::find_if(stations_, &Station::used);
  return first == stations_.end() ? settings_.address : first->address;
}

void Poses::collectOthers(bool collect) {
  collects_ = collect;
  if (collect) others_.clear();
}

std::size_t Poses::stationOf(const OscMessage& message, std::size_t& names_it) const noexcept {
  names_it = 0;
  for (std::size_t i = 0; named_by_address_ && i < kStations; ++i) {
    if (stations_[i].used && stations_[i].address == message.address) return i;
  }
  if (named_by_address_ || message.arguments.empty()) return kStations;
  const OscArgument& first = message.arguments.front();
  const std::size_t count = message.arguments.size();
  const bool named =
      first.kind == OscArgument::kText || count == kPosition + 1 || count == kPose + 1;
  names_it = named ? 1 : 0;
  for (std::size_t i = 0; i < kStations; ++i) {
    if (stations_[i].used && (!named || names(first, stations_[i].name))) return i;
  }
  return kStations;
}

void Poses::take(const OscMessage& message) noexcept {
  if (!named_by_address_ && message.address != settings_.address) return other(message);
  std::size_t skipped = 0;
  const std::size_t station = stationOf(message, skipped);
  if (station == kStations) {
    if (named_by_address_) return other(message);
    silence_ = kOtherStation;
    return;
  }
  const auto values = message.arguments.subspan(skipped);
  const bool formed = (values.size() == kPosition || values.size() == kPose) &&
                      std::ranges::all_of(values, isNumber);
  if (!formed) return bad(kNotFormed);
  TrackerSample sample = sample_[station];
  const auto value = [&](std::size_t i) { return static_cast<float>(values[i].number); };
  for (std::size_t i = 0; i < 3; ++i)
    sample.position_m[i] = static_cast<float>(settings_.scale * values[i].number);
  const bool real_first = settings_.quaternion == OscSettings::Quaternion::kWxyz;
  for (std::size_t i = 0; i < 4; ++i) {
    const float rest = i == 0 ? 1 : 0;
    const std::size_t at = kPosition + (real_first ? i : (i + 3) % 4);
    sample.orientation_wxyz[i] = values.size() == kPose ? value(at) : rest;
  }
  if (!plausible(sample)) return bad(faultOf(sample));
  normalise(sample.orientation_wxyz);
  place(settings_.placement, sample);
  if (!plausible(sample)) return bad(kPlacedTooFar);
  sample.received_ns = toNanoseconds(received_);
  ++sample.counter;
  sample_[station] = sample;
  ++samples_;
  silence_ = "";
  sink_.publish(sample);
}

void Poses::bad(const char* why) noexcept {
  ++bad_poses_;
  silence_ = why;
}

void Poses::other(const OscMessage& message) noexcept {
  silence_ = kOtherAddress;
  if (!collects_ || others_.size() >= kMostOthers) return;
  const std::string address = excerpt(message.address);
  if (std::ranges::find(others_, address) == others_.end()) others_.push_back(address);
}

}  // namespace merlin::osc
