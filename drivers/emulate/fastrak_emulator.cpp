#include "drivers/emulate/fastrak_emulator.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "daemon/base/random.h"
#include "drivers/emulate/wire.h"
#include "drivers/fastrak/protocol.h"

namespace merlin::emulate {
namespace {

constexpr Duration kCycle = std::chrono::nanoseconds(1'000'000'000 / 120);
constexpr Duration kStartTime = std::chrono::seconds(1);  // a real one takes up to 10 s
constexpr Duration kNever = std::chrono::hours(24 * 365);

constexpr double kPositionNoise_m = 0.76e-3;                       // RMS, each axis
constexpr double kAngleNoise_rad = 0.15 * std::numbers::pi / 180;  // RMS, about each axis
constexpr float kStationDistance_m = 0.2F;

constexpr char kSave = 0x0B, kReinitialise = 0x19, kSuspend = 0x13, kResume = 0x11;

// Codes of command errors. Source: MAN12.
constexpr int kMissing = -1, kNotNumeric = -2, kOutOfRange = -3, kUnknown = -99;

// A setting that a program can set and read back. Of all settings, only the alignment (A) affects
// the records.
struct Parameter {
  char letter;
  bool of_station;
  std::size_t fields;
  std::array<float, 9> initial;
};
constexpr Parameter kParameters[] = {
    {'H', true, 3, {1, 0, 0}},
    {'A', true, 9, {0, 0, 0, 200, 0, 0, 0, 200, 0}},
    {'G', true, 3, {}},
    {'I', true, 1, {}},
    {'N', true, 3, {}},
    {'V', true, 6, {200, 200, 200, -200, -200, -200}},
    {'Q', true, 6, {180, 90, 180, -180, -90, -180}},
    {'r', true, 3, {}},
    {'e', true, 1, {1}},
    {'x', false, 4, {0.2F, 0.2F, 0.8F, 0.95F}},
    {'v', false, 4, {0.2F, 0.2F, 0.8F, 0.95F}},
    {'y', false, 1, {}},
};
constexpr std::size_t kParameterCount = std::size(kParameters);
constexpr std::size_t kAlignment = 1;
static_assert(kParameters[kAlignment].letter == 'A');

// State that a program may set; ^K saves it, ^Y restores the saved state, W the factory settings.
struct State {
  bool binary = false, centimetres = false, compensation = false, continuous = false;
  fastrak::Stations active{};
  std::array<std::vector<int>, kStations> list;
  std::array<std::array<std::array<float, 9>, kStations>, kParameterCount> parameters{};
  // Orientation of each station that counts as straight ahead, set by the boresight command.
  std::array<std::array<float, 4>, kStations> ahead = {{{1}, {1}, {1}, {1}}};
  std::string configuration = "OutputCompensat CPG2030-003-10";
};

using Quaternion = std::array<float, 4>;

Quaternion conjugate(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

// Transforms a record into the frame that `a` gives by its origin, a point on its x axis and one on
// its y axis. No change if `a` is the default.
void align(const std::array<float, 9>& a, fastrak::Record& record) {
  if (a == kParameters[kAlignment].initial) return;
  using Eigen::Vector3f;
  const Vector3f origin(a[0], a[1], a[2]);
  const Vector3f x = (Vector3f(a[3], a[4], a[5]) - origin).normalized();
  Vector3f y = Vector3f(a[6], a[7], a[8]) - origin;
  y = (y - y.dot(x) * x).normalized();
  Eigen::Matrix3f axes;
  axes << x, y, x.cross(y);
  const Vector3f p(record.position.data());
  const Vector3f moved = axes.transpose() * (p - origin);
  std::copy(moved.begin(), moved.end(), record.position.begin());
  const Eigen::Quaternionf turn(axes);
  record.orientation_wxyz =
      product(conjugate({turn.w(), turn.x(), turn.y(), turn.z()}), record.orientation_wxyz);
}

using Fields = std::vector<std::optional<float>>;  // empty where a field is omitted

// Returns the comma-separated numbers of a command; nothing if one of them is not a number.
std::optional<Fields> split(std::string_view text) {
  Fields fields;
  for (;;) {
    std::string_view field = text.substr(0, text.find(','));
    const std::size_t taken = field.size();
    while (field.starts_with(' ') || field.starts_with('+')) field.remove_prefix(1);
    while (field.ends_with(' ')) field.remove_suffix(1);
    float value = 0;
    const char* end = field.data() + field.size();
    const auto parsed = std::from_chars(field.data(), end, value);
    if (!field.empty() && (parsed.ec != std::errc{} || parsed.ptr != end)) return std::nullopt;
    fields.push_back(field.empty() ? std::nullopt : std::optional(value));
    if (taken == text.size()) return fields;
    text.remove_prefix(taken + 1);
  }
}

class FastrakEmulator final : public Emulator {
 public:
  FastrakEmulator(const EmulatorSettings& settings, const MotionScript& script, Timestamp start)
      : receivers_(settings.model.empty() ? 1 : static_cast<std::size_t>(settings.model[0] - '0')),
        script_(script),
        start_(start),
        wire_(settings.baud, settings.garbage_every, settings.seed),
        noise_(settings.seed),
        state_(factoryState()),
        saved_(state_) {}

  void receive(std::span<const std::byte> bytes, Timestamp now) override {
    for (const std::byte b : bytes) {
      if (now < ready_at_) return;  // a unit that starts ignores its input
      const char c = static_cast<char>(b);
      if (executeControl(c, now) || c == '\n') continue;
      if (c == '\r') {
        if (!line_.empty()) executeLine();
        line_.clear();
      } else if (!line_.empty() || !executeLetter(c, now)) {
        if (line_.size() < 254) line_.push_back(c);
      }
    }
  }

  void advance(Timestamp now, std::string& out) override {
    if (!pending_.empty()) {
      wire_.reply(pending_, now, out);
      pending_.clear();
    }
    if (!streaming() || now < due_) return;
    if (now - due_ > kLongestDelay) due_ = now;
    // Uses the time of each cycle, so that late calls do not make the line busy for longer.
    for (; due_ <= now; due_ += kCycle) {
      nextStation();
      if (wire_.free(due_)) wire_.record(record(station_, due_), due_, out);  // dropped if not
    }
  }

  Timestamp nextDue() const override { return streaming() ? due_ : start_ + kNever; }

 private:
  State factoryState() const {
    State state;
    for (std::size_t i = 0; i < kStations; ++i) {
      state.active[i] = i < receivers_;
      state.list[i].assign(fastrak::kDefaultList.begin(), fastrak::kDefaultList.end());
      for (std::size_t p = 0; p < kParameterCount; ++p) {
        state.parameters[p][i] = kParameters[p].initial;
      }
    }
    return state;
  }

  bool streaming() const {
    return state_.continuous && !suspended_ && state_.active != fastrak::Stations{};
  }

  // Control characters act at once, even within a line, so that a program can abort a line by ^Y.
  bool executeControl(char c, Timestamp now) {
    switch (c) {
      case kReinitialise:
        due_ = ready_at_ = now + kStartTime;
        state_ = saved_;
        suspended_ = false;
        line_.clear();
        pending_.clear();
        return true;
      case kSave: saved_ = state_; return true;
      case kSuspend: suspended_ = true; return true;
      case kResume: suspended_ = false; return true;
      default: return false;
    }
  }

  // Executes a letter that takes effect without CR; returns false for any other letter.
  bool executeLetter(char c, Timestamp now) {
    switch (c) {
      case 'P': sendOnce(now); break;
      case 'C':
        if (!state_.continuous) due_ = now + kCycle;
        state_.continuous = true;
        break;
      case 'c': state_.continuous = false; break;
      case 'F': state_.binary = false; break;
      case 'f': state_.binary = true; break;
      case 'U': state_.centimetres = false; break;
      case 'u': state_.centimetres = true; break;
      case 'D': state_.compensation = true; break;
      case 'd': state_.compensation = false; break;
      case 'S': sendStatus(); break;
      case 'W': state_ = factoryState(); break;
      default: return false;
    }
    return true;
  }

  void sendOnce(Timestamp now) {
    for (std::size_t i = 0; i < kStations; ++i) {
      if (state_.active[i]) pending_ += record(i, now);
    }
  }

  void sendStatus() {
    pending_ +=
        fastrak::encode(fastrak::Status{state_.binary, state_.centimetres, state_.compensation,
                                        state_.continuous, 0, "3.00", state_.configuration});
  }

  void executeLine() {
    const char letter = line_[0];
    const std::string_view rest = std::string_view(line_).substr(1);
    switch (letter) {
      case 'Y':  // commands of other trackers, sent by VRPN
      case 't':
      case 'o':  // the speed of the line does not change
      case 'T': return;
      case 'X': return configure(rest);
      default: break;
    }
    const auto fields = split(rest);
    if (!fields) return refuse(kNotNumeric);
    if (letter == 'l') return setStation(*fields);
    if (letter == 'O') return setList(*fields);
    if (letter == 'R' || letter == 'B' || letter == 'b') return setFrame(letter, *fields);
    for (std::size_t p = 0; p < kParameterCount; ++p) {
      if (kParameters[p].letter == letter) return setParameter(p, *fields);
    }
    refuse(kUnknown);
  }

  // Sends an error reply. Its spacing in a real unit is not known.
  void refuse(int code) {
    pending_ += fmt::format("2 E*ERROR*{}*ERROR* EC {} *PS 0 *FL 0 *ST 0\r\n", line_, code);
  }

  void configure(std::string_view text) {
    if (text.empty()) {
      pending_ += fmt::format("2 X{:32.32}\r\n", state_.configuration);
    } else {
      state_.configuration = text.substr(0, 32);
    }
  }

  // Returns the index of the station that a command names; if there is none, sends an error reply
  // and returns nothing.
  std::optional<std::size_t> stationOf(const Fields& fields) {
    const float s = fields[0].value_or(1);
    if (s == 1 || s == 2 || s == 3 || s == 4) return static_cast<std::size_t>(s) - 1;
    refuse(kOutOfRange);
    return std::nullopt;
  }

  // A station without a receiver stays off.
  void setStation(const Fields& fields) {
    const auto station = stationOf(fields);
    if (!station) return;
    if (fields.size() > 1 && fields[1]) {
      state_.active[*station] = *fields[1] != 0 && *station < receivers_;
    } else {
      pending_ += fastrak::encode(state_.active, static_cast<int>(*station) + 1);
    }
  }

  // R resets the alignment, B sets the boresight to the present orientation, b resets the
  // boresight.
  void setFrame(char letter, const Fields& fields) {
    const auto station = stationOf(fields);
    if (!station) return;
    if (letter == 'R') state_.parameters[kAlignment][*station] = kParameters[kAlignment].initial;
    if (letter == 'b') state_.ahead[*station] = {1, 0, 0, 0};
    if (letter == 'B') state_.ahead[*station] = measured_[*station];
  }

  void setList(const Fields& fields) {
    const auto station = stationOf(fields);
    if (!station) return;
    if (fields.size() == 1) {
      pending_ += fmt::format("2{}O", *station + 1);
      for (const int item : state_.list[*station]) pending_ += fmt::format("{:2}", item);
      pending_ += "\r\n";
      return;
    }
    std::vector<int> list;
    for (std::size_t i = 1; i < fields.size(); ++i) {
      if (!fields[i]) return refuse(kMissing);
      const auto item = static_cast<int>(std::clamp(*fields[i], -1.0F, 100.0F));
      if (!fastrak::isItem(item)) return refuse(kOutOfRange);
      list.push_back(item);
    }
    state_.list[*station] = list;
  }

  // Omitted fields keep their values; a command without values is answered with the present ones.
  void setParameter(std::size_t index, const Fields& fields) {
    const Parameter& parameter = kParameters[index];
    const auto station = parameter.of_station ? stationOf(fields) : 0;
    if (!station) return;
    auto& values = state_.parameters[index][*station];
    const std::size_t first = parameter.of_station ? 1 : 0;
    bool given = false;
    for (std::size_t i = first; i < fields.size() && i - first < parameter.fields; ++i) {
      if (!fields[i]) continue;
      values[i - first] = *fields[i];
      given = true;
    }
    if (given) return;
    pending_ +=
        {'2', parameter.of_station ? static_cast<char>('1' + *station) : ' ', parameter.letter};
    for (std::size_t i = 0; i < parameter.fields; ++i) {
      pending_ += fmt::format("{:7.2f}", values[i]);
    }
    pending_ += "\r\n";
  }

  void nextStation() {
    do {
      station_ = (station_ + 1) % kStations;
    } while (!state_.active[station_]);
  }

  std::string record(std::size_t station, Timestamp now) {
    return fastrak::encode(measure(station, now), state_.list[station],
                           {state_.binary, state_.centimetres});
  }

  fastrak::Record measure(std::size_t station, Timestamp now) {
    const Motion motion = script_.at(now - start_);
    fastrak::Record record;
    record.station = static_cast<int>(station) + 1;
    const float unit_m = state_.centimetres ? 0.01F : 0.0254F;
    for (std::size_t i = 0; i < 3; ++i) {
      const float aside = i == 1 ? kStationDistance_m * static_cast<float>(station) : 0;
      const auto noise = static_cast<float>(kPositionNoise_m * noise_.normal());
      record.position[i] = (motion.position_m[i] + aside + noise) / unit_m;
    }
    record.orientation_wxyz = shaken(motion.orientation_wxyz);
    align(state_.parameters[kAlignment][station], record);
    measured_[station] = record.orientation_wxyz;
    record.orientation_wxyz = product(record.orientation_wxyz, conjugate(state_.ahead[station]));
    record.stylus = station == 0 && motion.ball_buttons != 0;
    return record;
  }

  // Returns `q`, rotated by a small random angle about each of its axes.
  std::array<float, 4> shaken(const std::array<float, 4>& q) {
    std::array<float, 3> h{};  // half angles, small
    for (float& half : h) half = static_cast<float>(kAngleNoise_rad / 2 * noise_.normal());
    const auto [w, x, y, z] = q;
    std::array<float, 4> r = {
        w - x * h[0] - y * h[1] - z * h[2], x + w * h[0] + y * h[2] - z * h[1],
        y + w * h[1] + z * h[0] - x * h[2], z + w * h[2] + x * h[1] - y * h[0]};
    const float norm = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    for (float& v : r) v /= norm;
    return r;
  }

  std::size_t receivers_;
  MotionScript script_;
  Timestamp start_;
  Wire wire_;
  Random noise_;
  State state_;
  State saved_;
  std::array<std::array<float, 4>, kStations> measured_{};  // newest orientation, before boresight
  std::string line_;
  std::string pending_;
  bool suspended_ = false;
  std::size_t station_ = kStations - 1;  // station measured last
  Timestamp ready_at_{};
  Timestamp due_{};
};

}  // namespace

std::unique_ptr<Emulator> makeFastrak(const EmulatorSettings& settings, const MotionScript& script,
                                      Timestamp start) {
  return std::make_unique<FastrakEmulator>(settings, script, start);
}

}  // namespace merlin::emulate
