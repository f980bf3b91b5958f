#include "drivers/emulate/cyberglove_emulator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "daemon/base/bytes.h"
#include "daemon/base/random.h"
#include "drivers/cyberglove/calibration.h"
#include "drivers/cyberglove/protocol.h"
#include "drivers/cyberglove/text.h"
#include "drivers/emulate/wire.h"
#include "drivers/hand/people.h"

namespace merlin::emulate {
namespace {

using namespace std::string_literals;
using cyberglove::Record;
using std::chrono::milliseconds;

constexpr Duration kRestartTime = milliseconds(1750);
constexpr Duration kShortestPeriod = std::chrono::nanoseconds(1'000'000'000 / 150);
constexpr Duration kNever = std::chrono::hours(24 * 365);
constexpr float kSensorCutoff_hz = 30;
constexpr double kTick = 1.0 / 115200;  // unit of the period and of the time stamps [s]

constexpr char kStop = 0x03, kReinitialise = 0x09, kRestart = 0x12;
constexpr std::string_view kSwitches = "DFJLQUWY";  // commands of one byte, 0 or 1
constexpr std::size_t kLongestCommand = 64;
constexpr const char* kInfo =
    "CyberGlove interface unit, emulated by MERLIN\r\n"
    "synthetic data, no glove";
constexpr const char* kSummary = "B D F G J L M N P Q S T U W Y ^C ^I ^R ?";

// Returns the length of a command, including its letter [bytes].
std::size_t lengthOf(char letter) {
  switch (letter) {
    case 'T': return 5;
    case 'M':
    case 'P': return 4;
    case 'N':
    case 'B':
    case '?': return 2;
    default: return kSwitches.find(letter) == std::string_view::npos ? 1 : 2;
  }
}

// State that a program may set; a restart resets all of it.
struct State {
  std::uint32_t mask = cyberglove::kMask22;
  std::uint8_t values = 22;
  std::uint8_t baud_divisor = 8;
  std::uint16_t w1 = 1152, w2 = 1;  // 100 Hz
  std::array<bool, kSwitches.size()> on{};

  bool& operator[](char letter) { return on[kSwitches.find(letter)]; }
};

class CybergloveEmulator final : public Emulator {
 public:
  CybergloveEmulator(const EmulatorSettings& settings, const MotionScript& script, Timestamp start)
      : hardware_mask_(settings.model == "18" ? cyberglove::kMask18 : cyberglove::kMask22),
        script_(script),
        start_(start),
        wire_(settings.baud, settings.garbage_every, settings.seed),
        noise_(settings.seed),
        person_(settings.person) {
    reset();
  }

  void receive(std::span<const std::byte> bytes, Timestamp now) override {
    for (const std::byte b : bytes) {
      if (restarting_ && now < ready_at_) return;  // a unit that starts ignores its input
      hear(static_cast<char>(b), now);
    }
  }

  void advance(Timestamp now, std::string& out) override {
    if (restarting_ && now >= ready_at_) {
      restarting_ = false;
      pending_ += kRestart + "\r\n\0"s;
    }
    if (!pending_.empty()) {
      wire_.reply(pending_, now, out);
      pending_.clear();
    }
    if (!streaming_ || now < nextDue()) return;
    due_ += period();
    if (now - due_ > kLongestDelay) due_ = now;
    wire_.record(record(false, streams_text_, now), now, out);
  }

  Timestamp nextDue() const override {
    if (restarting_) return ready_at_;
    return streaming_ ? std::max(due_, wire_.freeAt()) : start_ + kNever;
  }

 private:
  void reset() {
    state_ = {};
    state_.mask = hardware_mask_;
    state_.values = static_cast<std::uint8_t>(std::popcount(hardware_mask_));
    state_['F'] = state_['J'] = true;
    streaming_ = false;
    command_.clear();
    pending_.clear();
  }

  // A command of the ASCII dialogue ends with CR; after a binary one a CR has no meaning.
  void hear(char c, Timestamp now) {
    if (command_.empty() && (c == '\r' || c == '\n')) return;
    // The line may be incomplete because the previous client stopped.
    if (text_ && (c == kStop || c == kRestart)) command_.clear();
    command_.push_back(c);
    text_ = cyberglove::isText(command_);
    if (text_ && c == '\r')
      executeText(now);
    else if (!text_ && command_.size() >= lengthOf(command_[0]))
      execute(command_, now);
    else if (command_.size() < kLongestCommand)
      return;
    command_.clear();
  }

  void executeText(Timestamp now) {
    const auto command = cyberglove::ofText(command_);
    if (command && command->size() == lengthOf((*command)[0]))
      execute(*command, now);
    else
      refuse('n');
  }

  // Sends a reply (`binary`: without terminator) in the dialogue of the command.
  void reply(const std::string& binary) {
    pending_ += text_ ? cyberglove::asText(binary) + "\r\n\0"s : binary + '\0';
  }

  void execute(const std::string& command, Timestamp now) {
    switch (command[0]) {
      case 'G': pending_ += record(true, text_, now); break;
      case 'S':
        streaming_ = true;
        streams_text_ = text_;
        due_ = now + period();
        break;
      case kStop: streaming_ = false; [[fallthrough]];
      case kReinitialise: pending_ += command[0] + "\r\n\0"s; break;
      case kRestart:
        reset();
        restarting_ = true;
        ready_at_ = now + kRestartTime;
        break;
      case '?': answer(command[1]); break;
      default: set(command);
    }
  }

  void set(const std::string& command) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(command.data()) + 1;
    switch (command[0]) {
      case 'M':
        state_.mask = cyberglove::decodeMask(&command[1]) & hardware_mask_;
        state_.values = std::min(state_.values, enabled());
        break;
      case 'N':
        if (*data < 1 || *data > enabled()) return refuse('n');
        state_.values = *data;
        break;
      case 'T':
        state_.w1 = loadBe16(data);
        state_.w2 = loadBe16(data + 2);
        break;
      case 'B': state_.baud_divisor = *data; break;  // the speed of the line does not change
      case 'P': setFlags(data); break;
      default:
        if (kSwitches.find(command[0]) == std::string_view::npos) return refuse('?');
        if (*data > 1) return refuse('n');
        state_[command[0]] = *data == 1;
    }
    reply({command[0]});
  }

  void refuse(char code) { reply({'e', code}); }

  std::uint8_t enabled() const { return static_cast<std::uint8_t>(std::popcount(state_.mask)); }

  // Sets all switches from the argument of `P`; `?P` is the inverse.
  void setFlags(const std::uint8_t* flags) {
    state_['W'] = flags[0] & Record::kWristSwitch;
    state_['L'] = flags[0] & Record::kLight;
    state_['Y'] = flags[1] & 0x01;
    state_['U'] = flags[1] & 0x04;
    state_['J'] = flags[1] & 0x08;
    state_['F'] = flags[1] & 0x10;
    state_['D'] = flags[1] & 0x20;
    state_['Q'] = flags[2] & 0x01;
  }

  std::string flags() {
    const int second = 0xC0 | (state_['Y'] ? 0x01 : 0) | (state_['U'] ? 0x04 : 0) |  // valid, right
                       (state_['J'] ? 0x08 : 0) | (state_['F'] ? 0x10 : 0) |
                       (state_['D'] ? 0x20 : 0);
    return {static_cast<char>(status()), static_cast<char>(second), state_['Q'] ? '\1' : '\0'};
  }

  std::uint8_t status() {
    const bool light = state_['L'] || (state_['J'] && state_['W']);
    return static_cast<std::uint8_t>(Record::kAlways | Record::kPlugged |
                                     (state_['W'] ? Record::kWristSwitch : 0) |
                                     (light ? Record::kLight : 0));
  }

  void answer(char letter) {
    std::string value;
    switch (letter) {
      case 'B': value = static_cast<char>(state_.baud_divisor); break;
      case 'G': value = "\3"; break;
      case 'K': value = cyberglove::encodeMask(hardware_mask_); break;
      case 'M': value = cyberglove::encodeMask(state_.mask); break;
      case 'N': value = static_cast<char>(state_.values); break;
      case 'P': value = flags(); break;
      case 'R': value = "\1"; break;
      case 'S': value = static_cast<char>(std::popcount(hardware_mask_)); break;
      case 'T':
        appendBe16(value, state_.w1);
        appendBe16(value, state_.w2);
        break;
      case 'V': value = "\2\1\2\1"; break;
      case 'v': value = "2.1"; break;
      case 'i': value = kInfo; break;
      case '?': value = kSummary; break;
      default:
        if (kSwitches.find(letter) == std::string_view::npos) return refuse('?');
        value = state_[letter] ? '\1' : '\0';
    }
    reply(std::string{'?', letter} + value);
  }

  // Returns the requested period; 0 means as fast as possible.
  Duration askedPeriod() const { return fromSeconds(kTick * state_.w1 * state_.w2); }
  Duration period() const { return std::max(askedPeriod(), kShortestPeriod); }

  std::string record(bool single, bool text, Timestamp now) {
    smooth(script_.at(now - start_).glove_rad, now);
    const auto raw = cyberglove::rawOf(person_.sense(smoothed_, noise_), calibration_);
    const auto slots = cyberglove::slotsOf(state_.mask);
    Record record;
    for (std::size_t i = 0; i < state_.values; ++i) {
      record.values[i] = raw[slots.slot[i]];
    }
    record.single = single;
    record.timestamp =
        static_cast<std::uint32_t>(static_cast<std::uint64_t>(toSeconds(now - start_) / kTick));
    record.status = status();
    const Duration asked = askedPeriod();
    record.too_fast = !single && asked > Duration::zero() && asked < kShortestPeriod;
    return cyberglove::encode(record, {state_.values, state_['D'], state_['U'], text});
  }

  // Simulates the analogue first-order low-pass of each sensor.
  void smooth(const std::array<float, kGloveSlots>& angle_rad, Timestamp now) {
    const bool first = smoothed_at_ == Timestamp{};
    const auto dt = static_cast<float>(toSeconds(now - smoothed_at_));
    const float share =
        first ? 1 : 1 - std::exp(-2 * std::numbers::pi_v<float> * kSensorCutoff_hz * dt);
    for (std::size_t i = 0; i < kGloveSlots; ++i)
      smoothed_[i] += share * (angle_rad[i] - smoothed_[i]);
    smoothed_at_ = now;
  }

  std::uint32_t hardware_mask_;
  MotionScript script_;
  Timestamp start_;
  Wire wire_;
  Random noise_;
  hand::Person person_;  // person who wears the glove
  CybergloveSettings calibration_;
  State state_;
  std::string command_;
  std::string pending_;
  std::array<float, kGloveSlots> smoothed_{};
  Timestamp smoothed_at_{};
  bool restarting_ = false;
  bool streaming_ = false, streams_text_ = false;
  bool text_ = false;  // the current command belongs to the ASCII dialogue
  Timestamp ready_at_{};
  Timestamp due_{};
};

}  // namespace

std::unique_ptr<Emulator> makeCyberglove(const EmulatorSettings& settings,
                                         const MotionScript& script, Timestamp start) {
  return std::make_unique<CybergloveEmulator>(settings, script, start);
}

}  // namespace merlin::emulate
