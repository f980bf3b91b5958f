#include "drivers/emulate/spaceball_emulator.h"

#include <algorithm>
#include <cmath>

#include "drivers/emulate/wire.h"
#include "drivers/spaceball/protocol.h"

namespace merlin::emulate {
namespace {

using std::chrono::milliseconds;

constexpr Duration kResetTime = milliseconds(300);  // a real one takes about 2 s
constexpr Duration kDefaultPeriod = milliseconds(40);
constexpr Duration kNever = std::chrono::hours(24 * 365);
constexpr float kFullPush = 8000, kFullTwist = 1600;  // counts

spaceball::Model modelNamed(std::string_view name) {
  if (name == "3003") return spaceball::Model::k3003;
  if (name == "4000") return spaceball::Model::k4000;
  if (name == "1003") return spaceball::Model::k1003;
  return spaceball::Model::k2003;
}

const char* firmwareOf(spaceball::Model model) {
  switch (model) {
    case spaceball::Model::k3003: return "2.63";
    case spaceball::Model::k4000: return "2.43";
    case spaceball::Model::k1003: return "2.02";
    case spaceball::Model::k2003: break;
  }
  return "2.13";
}

class SpaceballEmulator final : public Emulator {
 public:
  SpaceballEmulator(const EmulatorSettings& settings, const MotionScript& script, Timestamp start)
      : model_(modelNamed(settings.model)),
        script_(script),
        start_(start),
        wire_(settings.baud, settings.garbage_every, settings.seed) {}

  void receive(std::span<const std::byte> bytes, Timestamp now) override {
    if (now < banner_at_ && resetting_) return;  // a ball that starts ignores its input
    for (const std::byte b : bytes) {
      const char c = static_cast<char>(b);
      if (c == '\n') continue;
      if (c != '\r') {
        if (command_.size() < 64) command_.push_back(c);
        continue;
      }
      execute(command_, now);
      command_.clear();
    }
  }

  void advance(Timestamp now, std::string& out) override {
    if (resetting_ && now >= banner_at_) {
      resetting_ = false;
      pending_ += banner();
    }
    if (!pending_.empty()) {
      wire_.reply(pending_, now, out);
      pending_.clear();
    }
    if (on_ && now >= due_) sample(now, out);
  }

  Timestamp nextDue() const override {
    if (resetting_) return banner_at_;
    return on_ ? std::max(due_, wire_.freeAt()) : start_ + kNever;
  }

 private:
  std::string banner() const {
    return std::string("\x11\r@1 Spaceball alive and well after a software reset.\r\n") +
           "@2 Firmware version " + firmwareOf(model_) + " created on 24-Oct-1997.\r\n";
  }

  void reset(Timestamp now) {
    resetting_ = true;
    banner_at_ = now + kResetTime;
    on_ = false;
    at_rest_ = true;
    period_ = kDefaultPeriod;
    buttons_ = 0;
  }

  void execute(const std::string& command, Timestamp now) {
    if (command.empty()) return;
    switch (command[0]) {
      case '@': reset(now); break;
      case 'C':
      case 'c': pending_ += "CB@\r"; break;
      case 'M': ballOn(now); break;
      case '-':
        on_ = false;
        pending_ += "-\r";
        break;
      case 'P': setPeriod(command); break;
      case 'Z': pending_ += "Z" + std::string(12, '@') + "\r"; break;
      case 'k': pending_ += spaceball::encodeKeys(buttons_, model_); break;
      case 'd': pending_ += spaceball::encode(measure(now)); break;
      case 'h': sayWhat(command); break;
      case 'B': break;  // a beep has no reply
      case 'N':
      case 'F':
      case 'Y':
      case 'A':
      case 'S':
      case '%': pending_ += command + "\r"; break;
      case ' ':
      case '\t': break;
      default: pending_ += "?" + command + "\r";
    }
  }

  void ballOn(Timestamp now) {
    pending_ += model_ == spaceball::Model::k4000 ? "M\r" : "MSSV\r";
    on_ = true;
    at_rest_ = false;  // so that a first packet is sent even at rest
    due_ = now;
    last_packet_ = now;
  }

  // "Pmmnn": maximum and minimum period in ms, two six-bit characters each; uses the minimum.
  void setPeriod(const std::string& command) {
    if (command.size() >= 5) {
      const int ms = (command[3] & 0x3F) << 6 | (command[4] & 0x3F);
      period_ = milliseconds(std::max(ms, 1));
    }
    pending_ += command + "\r";
  }

  void sayWhat(const std::string& command) {
    const std::string firmware = std::string("Firmware version ") + firmwareOf(model_);
    if (command == "hm" && model_ == spaceball::Model::k2003) {
      pending_ += "Hm2003B\r";
    } else if (command == "hm" && model_ == spaceball::Model::k3003) {
      pending_ += "Hm3003C\r";
    } else {
      pending_ += "Hv" + firmware + " created on 24-Oct-1997\r";
    }
  }

  spaceball::Displacement measure(Timestamp now) const {
    const Motion motion = script_.at(now - start_);
    spaceball::Displacement d;
    for (std::size_t i = 0; i < 6; ++i) {
      const float counts = motion.ball[i] * (i < 3 ? kFullPush : kFullTwist);
      d.axes[i] = static_cast<std::int16_t>(std::lround(std::clamp(counts, -32767.F, 32767.F)));
    }
    const auto period = std::chrono::duration_cast<std::chrono::microseconds>(now - last_packet_);
    d.period =
        static_cast<std::uint16_t>(std::min<std::int64_t>(period.count() * 16 / 1000, 65535));
    return d;
  }

  // Sends the keys when they change, and displacements while the ball is pushed. When it is
  // released, one displacement of zeros follows, then none.
  void sample(Timestamp now, std::string& out) {
    if (!wire_.free(now)) return;
    due_ = now + period_;
    const Motion motion = script_.at(now - start_);
    if (motion.ball_buttons != buttons_) {
      buttons_ = motion.ball_buttons;
      wire_.record(spaceball::encodeKeys(buttons_, model_), now, out);
    }
    const spaceball::Displacement d = measure(now);
    const bool rest = std::all_of(d.axes.begin(), d.axes.end(), [](auto a) { return a == 0; });
    if (rest && at_rest_) return;
    at_rest_ = rest;
    last_packet_ = now;
    wire_.record(spaceball::encode(d), now, out);
  }

  spaceball::Model model_;
  MotionScript script_;
  Timestamp start_;
  Wire wire_;
  std::string command_;
  std::string pending_;
  bool resetting_ = false;
  bool on_ = false;
  bool at_rest_ = true;
  std::uint32_t buttons_ = 0;
  Duration period_ = kDefaultPeriod;
  Timestamp banner_at_{};
  Timestamp due_{};
  Timestamp last_packet_{};
};

}  // namespace

std::unique_ptr<Emulator> makeSpaceball(const EmulatorSettings& settings,
                                        const MotionScript& script, Timestamp start) {
  return std::make_unique<SpaceballEmulator>(settings, script, start);
}

}  // namespace merlin::emulate
