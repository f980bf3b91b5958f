#include "config/checks.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include <fmt/format.h>

namespace merlin {
namespace {

class Checks {
 public:
  Checks(const std::map<std::string, int>& lines, std::vector<Finding>& findings)
      : lines_(lines), findings_(findings) {}

  void wrong(const std::string& pointer, std::string what) {
    // A setting that the file does not have stands nearest where its group does.
    int line = 0;
    for (std::string at = pointer; !at.empty() && line == 0; at.resize(at.rfind('/'))) {
      if (const auto found = lines_.find(at); found != lines_.end()) line = found->second;
    }
    findings_.push_back({false, line, pointer, std::move(what)});
  }

 private:
  const std::map<std::string, int>& lines_;
  std::vector<Finding>& findings_;
};

void checkName(const Settings& s, Checks& checks) {
  bool good = !s.instance.empty() && s.instance.size() <= 32;
  for (const char c : s.instance)
    good = good && (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_');
  if (!good)
    checks.wrong("/instance", fmt::format("is \"{}\"; allowed are 1 to 32 letters, digits, - and _",
                                          s.instance));
}

bool isAddress(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string port = text.substr(colon + 1);
  return text.starts_with("tcp://") && colon > 6 && !port.empty() && port.size() <= 5 &&
         port.find_first_not_of("0123456789") == std::string::npos;
}

bool knownPort(const std::string& port) {
  if (port.empty() || isAddress(port)) return true;
  for (const std::string form : {"serial:", "pty:", "replay:"}) {
    if (port.starts_with(form) && port.size() > form.size()) return true;
  }
  return false;
}

// Two programs on one line would each hear half of what the device says; so would two drivers.
void checkPortsDiffer(const DevicesSettings& d, Checks& checks) {
  std::map<std::string, const char*> taken;
  const std::pair<const char*, const LineSettings*> lines[] = {
      {"glove", &d.glove_line}, {"tracker", &d.tracker_line}, {"ball", &d.ball_line}};
  for (const auto& [device, line] : lines) {
    if (line->port.empty() || line->port.starts_with("replay:")) continue;
    const auto [first, fresh] = taken.emplace(line->port, device);
    if (fresh) continue;
    checks.wrong(fmt::format("/devices/{}/port", device),
                 fmt::format("is \"{}\", which is the {}'s port; each device has its own",
                             line->port, first->second));
  }
}

void checkGpio(const GpioSettings& g, Checks& checks) {
  std::set<int> seen;
  for (const int line : {g.projector_line, g.video_line, g.lamp_line, g.button_line}) {
    if (line >= 0 && !seen.insert(line).second)
      checks.wrong("/devices/gpio", fmt::format("has line {} twice; each has one purpose", line));
  }
}

// What speaks over a network is encrypted, or not at all.
void checkNetwork(const Settings& s, Checks& checks) {
  if (!s.serve.samples_endpoint.empty() && !isAddress(s.serve.samples_endpoint)) {
    checks.wrong("/serve/samples_endpoint",
                 fmt::format("is \"{}\"; allowed is tcp://ADDRESS:PORT, ADDRESS * for any",
                             s.serve.samples_endpoint));
  }
  if (!s.serve.samples_endpoint.empty() &&
      (s.serve.samples_keys.empty() || s.serve.samples_clients.empty())) {
    checks.wrong("/serve/samples_endpoint",
                 "needs samples_keys (merlin keys -o FILE) and samples_clients beside it");
  }
  const InputSettings& in = s.wall.input;
  if (in.endpoint.empty()) return;
  if (!isAddress(in.endpoint)) {
    checks.wrong("/wall/input/endpoint",
                 fmt::format("is \"{}\"; allowed is tcp://HOST:PORT, or \"\" for this machine's "
                             "devices",
                             in.endpoint));
  }
  if (in.keys.empty() || in.server_key.size() != 40) {
    checks.wrong(
        "/wall/input",
        "needs keys (merlin keys -o FILE) and server_key, the other machine's 40 characters");
  }
}

void checkLine(const LineSettings& line, const std::string& device, Checks& checks) {
  const std::string at = "/devices/" + device;
  if (!knownPort(line.port)) {
    checks.wrong(at + "/port",
                 fmt::format("is \"{}\"; allowed are serial:/dev/..., pty:PATH, tcp://HOST:PORT, "
                             "replay:FILE and \"\" for none",
                             line.port));
  }
  static const std::set<int> kSpeeds = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};
  if (!kSpeeds.count(line.baud)) {
    checks.wrong(at + "/baud",
                 fmt::format("is {}; allowed are {}", line.baud, fmt::join(kSpeeds, ", ")));
  }
}

template <std::size_t N>
void checkAxes(const std::array<int, N>& axes, const std::string& pointer, Checks& checks) {
  std::set<int> seen;
  for (const int axis : axes) seen.insert(std::abs(axis));
  if (seen.size() != N || seen.count(0)) {
    checks.wrong(pointer,
                 fmt::format("is {}; allowed is each of 1 to {} once, any of them negative",
                             fmt::join(axes, ", "), N));
  }
}

void checkRate(const render::GovernorSettings& g, Checks& checks) {
  if (g.min_triangles <= g.first_triangles && g.first_triangles <= g.max_triangles) return;
  checks.wrong(
      "/wall/rate",
      fmt::format("has min_triangles {}, first_triangles {}, max_triangles {}; they must rise",
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

// One input does not grab and fly at once, nor the same thing twice.
bool conflict(const render::Binding& a, const render::Binding& b) {
  if (a.input != b.input) return false;
  const bool same_moment = (a.when == render::When::kLeave) == (b.when == render::When::kLeave);
  return same_moment &&
         (a.action == b.action || (render::lasts(a.action) && render::lasts(b.action)));
}

void checkBindings(const std::vector<render::Binding>& bindings, Checks& checks) {
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const render::Binding& b = bindings[i];
    const std::string at = fmt::format("/wall/scene/bindings/{}", i);
    if (!isInput(b.input))
      checks.wrong(at + "/input",
                   fmt::format("is \"{}\"; allowed are ball.button.1 to ball.button.12, "
                               "posture.NAME and glove.switch",
                               b.input));
    if (b.when != render::When::kByAction &&
        (b.when == render::When::kHold) != render::lasts(b.action))
      checks.wrong(at + "/on",
                   "does not go with the action; allowed is hold for grab and fly, enter or leave "
                   "for reset_view and next_mode");
    for (std::size_t j = 0; j < i; ++j) {
      if (conflict(bindings[j], b))
        checks.wrong(at,
                     fmt::format("conflicts with binding {}: both give \"{}\" the same to do, or "
                                 "grab and fly at once",
                                 j, b.input));
    }
  }
}

}  // namespace

void checkTogether(const Settings& s, const std::map<std::string, int>& lines,
                   std::vector<Finding>& findings) {
  Checks checks(lines, findings);
  checkName(s, checks);
  checkLine(s.devices.glove_line, "glove", checks);
  checkLine(s.devices.tracker_line, "tracker", checks);
  checkLine(s.devices.ball_line, "ball", checks);
  checkPortsDiffer(s.devices, checks);
  checkGpio(s.devices.gpio, checks);
  checkNetwork(s, checks);
  checkAxes(s.devices.ball.axis_map, "/devices/ball/axis_map", checks);
  checkAxes(s.wall.scene.tracker_axes, "/wall/scene/tracker_axes", checks);
  checkRate(s.wall.governor, checks);
  checkBindings(s.wall.scene.bindings, checks);
}

}  // namespace merlin
