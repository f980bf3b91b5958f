#include "config/checks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

void checkName(const Settings& s, LoadedSettings& loaded) {
  bool good = !s.instance.empty() && s.instance.size() <= 32;
  for (const char c : s.instance)
    good = good && (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_');
  if (!good)
    loaded.wrong("/instance", fmt::format("is \"{}\"; allowed are 1 to 32 letters, digits, - and _",
                                          s.instance));
}

bool isNumber(std::string_view text, int low, int high) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && number >= low && number <= high;
}

// Host names are not checked further; a text of digits and dots alone must be an IPv4 address.
bool isHost(std::string_view host) {
  if (host.empty() || host.find_first_of("/ \t\n") != std::string_view::npos) return false;
  if (host.find_first_not_of("0123456789.") != std::string_view::npos) return true;
  int parts = 1;
  for (std::size_t dot = 0; (dot = host.find('.')) != std::string_view::npos; ++parts) {
    if (!isNumber(host.substr(0, dot), 0, 255)) return false;
    host.remove_prefix(dot + 1);
  }
  return parts == 4 && isNumber(host, 0, 255);
}

// Whether the text is "tcp://HOST:PORT" with a port from 1 to 65535.
bool isAddress(std::string_view text) {
  if (!text.starts_with("tcp://")) return false;
  text.remove_prefix(6);
  const std::size_t colon = text.rfind(':');
  return colon != std::string_view::npos && isHost(text.substr(0, colon)) &&
         isNumber(text.substr(colon + 1), 1, 65535);
}

bool knownPort(const std::string& port) {
  if (port.empty() || isAddress(port)) return true;
  for (const std::string form : {"serial:", "pty:", "replay:"}) {
    if (port.starts_with(form) && port.size() > form.size()) return true;
  }
  return false;
}

// Two drivers on one serial line would each read only a part of the device's bytes.
void checkPortsDiffer(const DevicesSettings& d, LoadedSettings& loaded) {
  std::map<std::string, const char*> taken;
  const std::pair<const char*, const LineSettings*> lines[] = {
      {"glove", &d.glove_line}, {"tracker", &d.tracker_line}, {"ball", &d.ball_line}};
  for (const auto& [device, line] : lines) {
    if (line->port.empty() || line->port.starts_with("replay:")) continue;
    const auto [first, fresh] = taken.emplace(line->port, device);
    if (fresh) continue;
    loaded.wrong(fmt::format("/devices/{}/port", device),
                 fmt::format("is \"{}\", which is the {}'s port; each device has its own",
                             line->port, first->second));
  }
}

void checkGpio(const GpioSettings& g, LoadedSettings& loaded) {
  std::set<int> seen;
  for (const int line : {g.projector_line, g.video_line, g.lamp_line, g.button_line}) {
    if (line >= 0 && !seen.insert(line).second)
      loaded.wrong("/devices/gpio", fmt::format("has line {} twice; each has one purpose", line));
  }
}

// Traffic over a network must be encrypted, so an address needs keys beside it.
void checkNetwork(const Settings& s, LoadedSettings& loaded) {
  if (!s.serve.samples_endpoint.empty() && !isAddress(s.serve.samples_endpoint)) {
    loaded.wrong(
        "/serve/samples_endpoint",
        fmt::format("is \"{}\"; allowed is tcp://ADDRESS:PORT, ADDRESS * for any, PORT 1 to "
                    "65535",
                    s.serve.samples_endpoint));
  }
  if (!s.serve.samples_endpoint.empty() &&
      (s.serve.samples_keys.empty() || s.serve.samples_clients.empty())) {
    loaded.wrong("/serve/samples_endpoint",
                 "needs samples_keys (merlin keys -o FILE) and samples_clients beside it");
  }
  const InputSettings& in = s.wall.input;
  if (in.endpoint.empty()) return;
  if (!isAddress(in.endpoint)) {
    loaded.wrong("/wall/input/endpoint",
                 fmt::format("is \"{}\"; allowed is tcp://HOST:PORT, PORT 1 to 65535, or \"\" for "
                             "this machine's devices",
                             in.endpoint));
  }
  if (in.keys.empty() || in.server_key.size() != 40) {
    loaded.wrong("/wall/input",
                 "needs keys (merlin keys -o FILE) and server_key, the other machine's public key "
                 "of 40 characters");
  }
}

void checkLine(const LineSettings& line, const std::string& device, LoadedSettings& loaded) {
  const std::string at = "/devices/" + device;
  if (!knownPort(line.port)) {
    loaded.wrong(at + "/port",
                 fmt::format("is \"{}\"; allowed are serial:/dev/..., pty:PATH, tcp://HOST:PORT, "
                             "replay:FILE and \"\" for none",
                             line.port));
  }
  static const std::set<int> kSpeeds = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
  if (!kSpeeds.count(line.baud)) {
    loaded.wrong(at + "/baud",
                 fmt::format("is {}; allowed are {}", line.baud, fmt::join(kSpeeds, ", ")));
  }
}

// Whether the line can carry rate_hz records: 10 bits a byte (8N1), the longest record (22
// sensors).
void checkGloveRate(const DevicesSettings& d, LoadedSettings& loaded) {
  const bool text = d.glove.dialogue == CybergloveSettings::Dialogue::kText;
  const int stamp = d.glove.time_stamps ? (text ? 11 : 5) : 0;
  const int bytes = (text ? 96 : 25) + stamp;
  const double most = d.glove_line.baud / 10.0 / bytes;
  const bool has_speed =
      d.glove_line.port.starts_with("serial:") ||
      d.glove_line.port.starts_with("pty:");  // the speed behind a server is unknown
  if (!has_speed || d.glove.rate_hz <= most) return;
  loaded.wrong("/devices/glove/rate_hz",
               fmt::format("is {:g}, and a line of {} baud carries {:.0f} records of {} bytes a "
                           "second: ask for fewer, or set the line faster",
                           d.glove.rate_hz, d.glove_line.baud, std::floor(most), bytes));
}

template <std::size_t N>
void checkAxes(const std::array<int, N>& axes, const std::string& pointer, LoadedSettings& loaded) {
  std::set<int> seen;
  for (const int axis : axes) seen.insert(std::abs(axis));
  if (seen.size() != N || seen.count(0)) {
    loaded.wrong(pointer,
                 fmt::format("is {}; allowed is each of 1 to {} once, any of them negative",
                             fmt::join(axes, ", "), N));
  }
}

void checkRate(const render::GovernorSettings& g, LoadedSettings& loaded) {
  if (g.min_triangles <= g.first_triangles && g.first_triangles <= g.max_triangles) return;
  loaded.wrong("/wall/rate", fmt::format("has min_triangles {}, first_triangles {}, max_triangles "
                                         "{}; they must be in ascending order",
                                         g.min_triangles, g.first_triangles, g.max_triangles));
}

bool isInput(const std::string& input) {
  if (input == "glove.switch") return true;
  if (input.starts_with("posture.")) return input.size() > 8;
  for (int button = 1; button <= 12; ++button) {
    if (input == fmt::format("ball.button.{}", button)) return true;
  }
  return false;
}

bool atLeave(const render::Binding& b) { return b.when == render::When::kLeave; }

std::string conflictText(const render::Binding& a, const render::Binding& b) {
  const char* when = render::lasts(b.action) ? "held" : atLeave(b) ? "left" : "entered";
  if (a.action == b.action)
    return fmt::format("\"{}\" would {} twice when {}", b.input, nameOf(b.action), when);
  return fmt::format("\"{}\" would both {} and {} when {}, which exclude each other", b.input,
                     nameOf(a.action), nameOf(b.action), when);
}

// At one moment (hold, enter, leave) one input must not trigger two actions that exclude each
// other, nor one action twice. Linear in the bindings: for each moment, at most one binding of each
// action is remembered.
void checkBindings(const std::vector<render::Binding>& bindings, LoadedSettings& loaded) {
  constexpr const char* kPointer = "/wall/scene/bindings/{}";
  std::map<std::pair<std::string, bool>, std::vector<std::size_t>> before;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const render::Binding& b = bindings[i];
    const std::string at = fmt::format(kPointer, i);
    if (!isInput(b.input))
      loaded.wrong(at + "/input",
                   fmt::format("is \"{}\"; allowed are ball.button.1 to ball.button.12, "
                               "posture.NAME and glove.switch",
                               b.input));
    if (b.when != render::When::kByAction &&
        (b.when == render::When::kHold) != render::lasts(b.action))
      loaded.wrong(at + "/on",
                   fmt::format("does not go with {}; allowed is {}", nameOf(b.action),
                               render::lasts(b.action) ? "hold: it lasts"
                                                       : "enter or leave: it happens once"));
    auto& same_moment = before[{b.input, atLeave(b)}];
    const auto j = std::find_if(same_moment.begin(), same_moment.end(), [&](std::size_t k) {
      return render::exclude(bindings[k].action, b.action);
    });
    if (j == same_moment.end()) {
      same_moment.push_back(i);
      continue;
    }
    const std::string other = fmt::format(kPointer, *j);
    loaded.wrong(at, fmt::format("conflicts with {} (line {}): {}", other, loaded.lineOf(other),
                                 conflictText(bindings[*j], b)));
  }
}

// Finds a panel button whose command could never have an effect.
void checkButton(const Settings& s, LoadedSettings& loaded) {
  const std::string at = "/devices/gpio/button_command", &command = s.devices.gpio.button_command;
  if (s.devices.gpio.chip.empty() || s.devices.gpio.button_line < 0) return;
  if (command == "snapshot" && s.wall.snapshots.empty())
    loaded.wrong(at, "is snapshot, which needs a folder: /wall/snapshots names none");
  if (command == "next_content" && s.wall.contents.empty())
    loaded.wrong(at, "is next_content, and there is one model only: /wall/contents names none");
}

// Finds bindings whose action could never have an effect.
void checkDoers(const Settings& s, LoadedSettings& loaded) {
  const auto& bindings = s.wall.scene.bindings;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const render::Action action = bindings[i].action;
    const std::string at = fmt::format("/wall/scene/bindings/{}/action", i);
    if (action == render::Action::kSnapshot && s.wall.snapshots.empty())
      loaded.wrong(at, "is snapshot, which needs a folder: /wall/snapshots names none");
    if (action == render::Action::kNextContent && s.wall.contents.empty())
      loaded.wrong(at, "is next_content, and there is one model only: /wall/contents names none");
    if (render::isLamp(action) && (s.devices.gpio.chip.empty() || s.devices.gpio.lamp_line < 0))
      loaded.wrong(at, fmt::format("is {}, which needs a lamp: /devices/gpio has no chip with a "
                                   "lamp_line",
                                   nameOf(action)));
  }
}

void checkOutputs(const WallSettings& wall, LoadedSettings& loaded) {
  for (const auto& [pointer, what] : render::validate(wall.outputs))
    loaded.wrong("/wall/outputs" + pointer, what);
  const bool shared = std::any_of(wall.outputs.begin(), wall.outputs.end(), [](const auto& o) {
    return o.kind == render::OutputKind::kSharedMemory;
  });
  if (!wall.snapshots.empty() && !shared) {
    loaded.wrong("/wall/snapshots",
                 "needs an output of kind shared_memory, from which snapshots are taken; "
                 "/wall/outputs has none");
  }
}

void checkGroup(const SettingFaults& faults, const std::string& group, LoadedSettings& loaded) {
  for (const auto& [pointer, what] : faults)
    loaded.wrong(group + pointer, "cannot be used: " + what);
}

}  // namespace

void checkTogether(LoadedSettings& loaded) {
  const Settings& s = loaded.settings;
  checkName(s, loaded);
  checkLine(s.devices.glove_line, "glove", loaded);
  checkLine(s.devices.tracker_line, "tracker", loaded);
  checkLine(s.devices.ball_line, "ball", loaded);
  checkPortsDiffer(s.devices, loaded);
  checkGloveRate(s.devices, loaded);
  checkGpio(s.devices.gpio, loaded);
  checkNetwork(s, loaded);
  checkAxes(s.devices.ball.axis_map, "/devices/ball/axis_map", loaded);
  checkGroup(render::validate(s.wall.tiles), "/wall/tiles", loaded);
  checkGroup(render::validate(s.wall.scene), "/wall/scene", loaded);
  checkOutputs(s.wall, loaded);
  checkRate(s.wall.governor, loaded);
  checkBindings(s.wall.scene.bindings, loaded);
  checkButton(s, loaded);
  checkDoers(s, loaded);
}

}  // namespace merlin
