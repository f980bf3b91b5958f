#include "daemon/cli/devices/live_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"
#include "drivers/io/evdev_stream.h"
#include "drivers/port/axis_names.h"

namespace merlin::cli {
namespace {

constexpr int kHalfBar = 10;  // characters on each side of the middle

// Returns the name that bindings use for the key or button with this kernel code: "key.space",
// "button.south".
std::string inputOf(std::uint16_t code) {
  std::string name = io::keyNameOf(code);
  if (name.starts_with("key_")) return "key." + name.substr(4);
  if (name.starts_with("btn_")) return "button." + name.substr(4);
  return fmt::format("number {}", code);
}

// Returns the lines of a ball: its axes, pressed buttons and keys, by the names that bindings use
// after the device's name.
std::string ballLines(const BallSample& ball) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    const float share = i < 3 ? ball.translation[i] : ball.rotation[i - 3];
    const std::string name = fmt::format("axis.{}{}", kAxisNames[i],
                                         share > 0   ? "+"
                                         : share < 0 ? "-"
                                                     : "");
    text += fmt::format("    {:8} {} {:6.3f}  raw {}\n", name, axisBar(share), share, ball.raw[i]);
  }
  std::string pressed;
  for (int button = 0; button < 12; ++button) {
    if (ball.buttons >> button & 1) pressed += fmt::format(" button.{}", button + 1);
  }
  for (const std::uint16_t code : ball.keys) {
    if (code != 0) pressed += " " + inputOf(code);
  }
  return text + fmt::format("    pressed {}\n", pressed.empty() ? " none" : pressed);
}

std::string gloveLines(const GloveSample& glove, const shm::SeqSlot<PostureState>& state) {
  std::string joints;
  for (std::size_t i = 0; i < std::size(glove.angle_rad); ++i) {
    if (i % 8 == 0) joints += i == 0 ? "    degrees " : "\n            ";
    joints += fmt::format(" {:6.1f}", glove.angle_rad[i] * 180 / std::numbers::pi_v<float>);
  }
  const auto posture = state.read();
  const std::string name = posture ? posture->name : "";
  return fmt::format("{}\n    posture  {}\n", joints, name.empty() ? "none" : name);
}

// Returns a line for each hand whose gestures are recognised, with its last gesture.
std::string gestureLines(const shm::DeviceSlots& devices, Timestamp now) {
  std::string text;
  for (const auto& hand : devices.hands) {
    const auto g = hand.gesture->read();
    if (!g) continue;
    const std::string last = g->counter == 0
                                 ? "none"
                                 : fmt::format("{}, {:.1f} s ago", textIn(g->name),
                                               toSeconds(now - fromNanoseconds(g->received_ns)));
    text += fmt::format("  {:10} gesture  {}  ({} so far)\n", hand.name, last, g->counter);
  }
  return text;
}

std::string trackerLines(const shm::DeviceSlots::Tracker& tracker) {
  std::string text;
  for (const auto* channel : tracker.stations) {
    const auto s = channel->newest();
    if (!s) continue;
    text += fmt::format(
        "    station {}  {:7.3f} {:7.3f} {:7.3f} m  turned {:5.3f} {:6.3f} {:6.3f} "
        "{:6.3f}{}\n",
        s->station, s->position_m[0], s->position_m[1], s->position_m[2], s->orientation_wxyz[0],
        s->orientation_wxyz[1], s->orientation_wxyz[2], s->orientation_wxyz[3],
        s->stylus ? "  button" : "");
  }
  return text;
}

std::string touchLines(const TouchSample& touch) {
  std::string text = touch.fingers == 0 ? "    no finger\n" : "";
  for (std::size_t i = 0; i < std::min<std::size_t>(touch.fingers, kFingers); ++i) {
    text += fmt::format("    finger {}  {:5.3f} to the right, {:5.3f} down\n", touch.id[i],
                        touch.position[i][0], touch.position[i][1]);
  }
  std::string pressed;
  for (std::uint16_t bit = 0; bit < 16; ++bit) {
    if (touch.buttons >> bit & 1)
      pressed += " " + inputOf(static_cast<std::uint16_t>(kFirstMouseButton + bit));
  }
  if (!pressed.empty()) text += fmt::format("    pressed {}\n", pressed);
  return text;
}

std::string valuesOf(const std::string& device, const shm::DeviceSlots& devices) {
  if (const auto* const slots = devices.ball(device)) {
    const auto ball = slots->samples->newest();
    return ball ? ballLines(*ball) : "";
  }
  if (const auto* const slots = devices.glove(device)) {
    const auto glove = slots->samples->newest();
    return glove ? gloveLines(*glove, *slots->posture_state) : "";
  }
  if (const auto* const slots = devices.touch(device)) {
    const auto touch = slots->samples->newest();
    return touch ? touchLines(*touch) : "";
  }
  const auto* const tracker = devices.tracker(device);
  return tracker ? trackerLines(*tracker) : "";
}

}  // namespace

std::string axisBar(float share) {
  const int length = static_cast<int>(std::lround(std::min(std::abs(share), 1.0F) * kHalfBar));
  const auto bar = [&](bool filled) {
    return std::string(static_cast<std::size_t>(filled ? length : 0), '#');
  };
  return fmt::format("[{:>{}}|{:<{}}]", bar(share < 0), kHalfBar, bar(share > 0), kHalfBar);
}

std::string liveTable(const shm::DeviceSlots& devices, Timestamp now) {
  std::string text;
  for (const auto& [device, slot] : devices.health) {
    const auto health = slot->read();
    if (!health) continue;
    const std::string_view state = shm::healthName(*health, now);
    const std::string_view identity = state == "ok" ? health->identity : "", why = health->reason;
    text += fmt::format("  {:10} {:8} {:7.1f} Hz  {}{}{}\n", device, state, health->rate_hz,
                        identity, identity.empty() || why.empty() ? "" : "; ", why);
    if (state == "ok") text += valuesOf(device, devices);
  }
  return text + gestureLines(devices, now);
}

}  // namespace merlin::cli
