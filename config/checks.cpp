#include "config/checks.h"

#include <cmath>
#include <cstdlib>
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

void checkLine(const LineSettings& line, const std::string& device, Checks& checks) {
  const std::string at = "/devices/" + device;
  const bool known = line.port.empty() ||
                     (line.port.starts_with("serial:") && line.port.size() > 7) ||
                     (line.port.starts_with("pty:") && line.port.size() > 4);
  if (!known) {
    checks.wrong(at + "/port",
                 fmt::format("is \"{}\"; allowed are serial:/dev/..., pty:PATH and \"\" for none",
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

}  // namespace

void checkTogether(const Settings& s, const std::map<std::string, int>& lines,
                   std::vector<Finding>& findings) {
  Checks checks(lines, findings);
  checkName(s, checks);
  checkLine(s.devices.glove_line, "glove", checks);
  checkLine(s.devices.tracker_line, "tracker", checks);
  checkLine(s.devices.ball_line, "ball", checks);
  checkAxes(s.devices.ball.axis_map, "/devices/ball/axis_map", checks);
  checkAxes(s.wall.scene.tracker_axes, "/wall/scene/tracker_axes", checks);
  checkRate(s.wall.governor, checks);
}

}  // namespace merlin
