#include "daemon/cli/devices/plugged.h"

#include <algorithm>
#include <bitset>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <grp.h>
#include <linux/input-event-codes.h>
#include <sys/stat.h>
#include <unistd.h>

#include "drivers/evdev/input_device.h"
#include "drivers/io/evdev_stream.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    entries.push_back(at->path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::string firstLine(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

// Returns the path with links resolved, or the path itself if that fails.
std::string withoutLinks(const fs::path& path) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  return error ? path.string() : real.string();
}

std::string groupOf(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  const group* const owner = ::getgrgid(status.st_gid);  // NOLINT(concurrency-mt-unsafe)
  return owner ? owner->gr_name : "";
}

// Maps each file to the link that points to it in the folder, such as /dev/input/by-id. The names
// of these links stay the same when a device is plugged in elsewhere. If several links point to one
// file, the last one is taken, which for a gamepad is "...-event-joystick".
std::map<std::string, std::string> linksOf(const fs::path& folder) {
  std::map<std::string, std::string> links;
  for (const fs::path& entry : entriesOf(folder)) links[withoutLinks(entry)] = entry.string();
  return links;
}

// Reads a bitmap from a file of /sys: words of 64 bits in hexadecimal, the most significant word
// first.
template <std::size_t N>
std::bitset<N> bitmap(const fs::path& file) {
  std::istringstream words(firstLine(file));
  std::vector<std::string> all;
  for (std::string word; words >> word;) all.push_back(word);
  std::bitset<N> bits;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const unsigned long long word = std::strtoull(all[all.size() - 1 - i].c_str(), nullptr, 16);
    for (std::size_t bit = 0; bit < 64 && 64 * i + bit < N; ++bit)
      bits[64 * i + bit] = word >> bit & 1;
  }
  return bits;
}

// The keys and axes of an input device, by the event codes of the kernel.
struct Capabilities {
  explicit Capabilities(const fs::path& folder)
      : keys(bitmap<KEY_CNT>(folder / "key")),
        absolute(bitmap<ABS_CNT>(folder / "abs")),
        relative(bitmap<REL_CNT>(folder / "rel")) {}

  std::bitset<KEY_CNT> keys;
  std::bitset<ABS_CNT> absolute;
  std::bitset<REL_CNT> relative;
};

// Returns the kind of an input device; empty if MERLIN cannot use it (a power button, a lid
// switch).
std::string kindOf(const Capabilities& has) {
  const auto six = [](const auto& axes) {
    for (int code = ABS_X; code <= ABS_RZ; ++code) {
      if (!axes[static_cast<std::size_t>(code)]) return false;
    }
    return true;
  };
  if (has.keys[BTN_GAMEPAD]) return "gamepad";
  if (has.keys[BTN_JOYSTICK]) return "joystick";
  if (six(has.absolute) || six(has.relative)) return "space mouse";
  const bool pressed = has.keys[BTN_TOUCH] || has.keys[BTN_MOUSE];
  if (has.absolute[ABS_MT_POSITION_X] || (has.absolute[ABS_X] && has.absolute[ABS_Y] && pressed))
    return "touch screen";
  if (has.keys[BTN_MOUSE] && has.relative[REL_X]) return "mouse";
  if (has.keys[KEY_PAGEDOWN] || has.keys[KEY_NEXT]) return has.keys[KEY_A] ? "keyboard" : "clicker";
  return {};
}

// Returns the drivers that can read an input device of this kind, with a short name for the device.
std::vector<Plugged::Use> usesOf(const std::string& kind) {
  if (kind == "gamepad") return {{"pad", "evdev"}};
  if (kind == "joystick") return {{"stick", "evdev"}};
  if (kind == "space mouse") return {{"mouse", "evdev"}};
  if (kind == "touch screen") return {{"touch", "touch"}};
  if (kind == "mouse") return {{"mouse", "evdev"}, {"touch", "touch"}};
  return {{kind, "evdev"}};
}

// Fills in axes, keys and `usual` as the driver evdev would. The ranges of the axes, which the
// kernel tells only to programs that open the device, are not needed for that.
void describeInput(const Capabilities& has, Plugged& plugged) {
  evdev::InputDevice input;
  EvdevRecord record;
  record.high = 1;
  record.kind = EvdevRecord::kAxis;
  for (std::size_t code = 0; code < has.absolute.size(); ++code) {
    record.code = static_cast<std::uint16_t>(code);
    if (has.absolute[code]) input.describe(record);
  }
  record.kind = EvdevRecord::kRelative;
  for (std::size_t code = 0; code < has.relative.size(); ++code) {
    record.code = static_cast<std::uint16_t>(code);
    if (has.relative[code]) input.describe(record);
  }
  for (std::size_t code = 0; code < has.keys.size(); ++code) {
    if (has.keys[code]) input.describe(io::keyRecord(static_cast<std::uint16_t>(code)));
  }
  (void)input.choose({});  // without settings, the driver chooses the usual axes and keys
  plugged.axes = input.axisNames();
  plugged.keys = input.keyNames();
  plugged.usual = input.chosen();
}

void addAdapters(const std::string& root, std::vector<Plugged>& all) {
  const auto links = linksOf(root + "/dev/serial/by-id");
  std::map<std::string, std::string> found = links;  // maps each device file to its link
  for (const fs::path& entry : entriesOf(root + "/sys/class/tty")) {
    const std::string name = entry.filename();
    const bool adapter = name.starts_with("ttyUSB") || name.starts_with("ttyACM");
    const std::string device = fmt::format("{}/dev/{}", root, name);
    if (adapter && fs::exists(device)) found.emplace(withoutLinks(device), device);
  }
  for (const auto& [path, name] : found) {
    all.push_back({"serial adapter",
                   fs::path(name).filename(),
                   "serial:" + name,
                   path,
                   {{"glove", "cyberglove"}, {"tracker", "fastrak"}, {"ball", "spaceball"}},
                   ::access(path.c_str(), R_OK | W_OK) == 0,
                   groupOf(path),
                   {},
                   {},
                   {}});
  }
}

void addInputDevices(const std::string& root, std::vector<Plugged>& all) {
  const auto links = linksOf(root + "/dev/input/by-id");
  std::vector<Plugged> found;
  for (const fs::path& entry : entriesOf(root + "/sys/class/input")) {
    if (!entry.filename().string().starts_with("event")) continue;
    const Capabilities has(entry / "device/capabilities");
    const std::string kind = kindOf(has);
    if (kind.empty()) continue;
    const std::string path = withoutLinks(root + "/dev/input/" + entry.filename().string());
    std::error_code error;
    if (!fs::exists(path, error) && !error) continue;  // was unplugged in the meantime
    const auto link = links.find(path);
    found.push_back({kind,
                     firstLine(entry / "device/name"),
                     "evdev:" + (link == links.end() ? path : link->second),
                     path,
                     usesOf(kind),
                     ::access(path.c_str(), R_OK) == 0,
                     groupOf(path),
                     {},
                     {},
                     {}});
    if (kind != "touch screen")
      // Touch screens are read by the driver touch, not by evdev.
      describeInput(has, found.back());
  }
  std::ranges::stable_sort(found, {}, &Plugged::name);
  all.insert(all.end(), found.begin(), found.end());
}

void addSpacenavd(const std::string& root, std::vector<Plugged>& all) {
  const std::string path = root + "/run/spnav.sock";
  std::error_code error;
  if (!fs::is_socket(path, error)) return;
  all.push_back({"space-mouse socket",
                 "spacenavd, or another program that serves as one",
                 "unix:" + path,
                 path,
                 {{"mouse", "spacenav"}},
                 ::access(path.c_str(), R_OK | W_OK) == 0,
                 groupOf(path),
                 {},
                 {},
                 {}});
}

}  // namespace

std::vector<Plugged> findPlugged(const std::string& root) {
  std::vector<Plugged> all;
  addAdapters(root, all);
  addInputDevices(root, all);
  addSpacenavd(root, all);
  return all;
}

std::string freeName(const std::string& wanted, const std::vector<std::string>& taken) {
  std::string name = wanted;
  for (int n = 2; std::ranges::find(taken, name) != taken.end(); ++n)
    name = fmt::format("{}_{}", wanted, n);
  return name;
}

void nameApart(std::vector<Plugged>& all, std::vector<std::string> taken) {
  for (Plugged& plugged : all) {
    for (Plugged::Use& use : plugged.uses) use.name = freeName(use.name, taken);
    if (plugged.uses.size() == 1) taken.push_back(plugged.uses.front().name);
  }
}

std::string configurationEntry(const Plugged& plugged, const Plugged::Use& use) {
  return fmt::format(R"({{"name": "{}", "driver": "{}", "port": "{}"}})", use.name, use.driver,
                     plugged.port);
}

}  // namespace merlin::cli
