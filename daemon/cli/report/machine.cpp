#include "daemon/cli/report/machine.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/version.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 1 << 20;  // limit for one file of /sys or /proc

// Reads a file until its end or kMostBytes; the sizes that files of /sys and /proc state (0 or
// 4096) are wrong.
std::string contentOf(const std::string& path) {
  const UniqueFd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  std::string content;
  char buffer[4096];
  while (file.valid() && content.size() < kMostBytes) {
    const ssize_t n = ::read(file.get(), buffer, sizeof buffer);
    if (n <= 0) break;
    content.append(buffer, static_cast<std::size_t>(n));
  }
  return content;
}

// Returns the first line of a file, without blanks at its end.
std::string firstLine(const std::string& path) {
  std::string line = contentOf(path);
  line.resize(std::min(line.find('\n'), line.size()));
  line.resize(line.find_last_not_of(" \t\r") + 1);
  return oneLine(line);
}

std::vector<std::string> namesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

// Returns the last component of the target of a link; empty if the path is no link.
std::string linkName(const std::string& path) {
  std::error_code error;
  return fs::read_symlink(path, error).filename().string();
}

// Returns the value of the first line "KEY: VALUE" or "KEY=VALUE" of `text`; empty if there is
// none. `sign`: ':' or '='.
std::string valueOf(const std::string& text, std::string_view key, char sign) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t at = line.find(sign);
    if (at == std::string::npos || line.find_first_not_of(" \t", key.size()) != at) continue;
    const std::size_t begin = line.find_first_not_of(" \t\"", at + 1);
    if (begin == std::string::npos) return {};
    return oneLine(line.substr(begin, line.find_last_not_of(" \"") + 1 - begin));
  }
  return {};
}

std::string cpuText(const std::string& root) {
  const std::string info = contentOf(root + "/proc/cpuinfo");
  return fmt::format("{}, {} processors\n", valueOf(info, "model name", ':'),
                     firstLine(root + "/sys/devices/system/cpu/online"));
}

std::string memoryText(const std::string& root) {
  const std::string info = contentOf(root + "/proc/meminfo");
  return fmt::format("{} in all, {} available, {} swap\n", valueOf(info, "MemTotal", ':'),
                     valueOf(info, "MemAvailable", ':'), valueOf(info, "SwapTotal", ':'));
}

std::string disksText(const std::string& root) {
  std::string text;
  for (const char* folder : {"/", "/var/lib/merlin", "/run", "/dev/shm", "/tmp"}) {
    struct statvfs disk {};
    if (::statvfs((root + folder).c_str(), &disk) != 0) continue;
    text += fmt::format("{}: {} of {} MB free\n", folder, disk.f_bavail * disk.f_frsize / 1'000'000,
                        disk.f_blocks * disk.f_frsize / 1'000'000);
  }
  return text;
}

std::string cardsText(const std::string& root) {
  std::string text;
  const std::string folder = root + "/sys/class/drm/";
  for (const std::string& name : namesIn(folder)) {
    const std::string device = folder + name + "/device/";
    const bool connector = name.find('-') != std::string::npos;
    if (connector || !(name.starts_with("card") || name.starts_with("renderD"))) continue;
    text += fmt::format("{}: driver {}, PCI id {}:{}\n", name, linkName(device + "driver"),
                        firstLine(device + "vendor"), firstLine(device + "device"));
  }
  return text;
}

std::string connectorsText(const std::string& root) {
  std::string text;
  const std::string folder = root + "/sys/class/drm/";
  for (const std::string& name : namesIn(folder)) {
    if (name.find('-') == std::string::npos) continue;
    const std::string modes = contentOf(folder + name + "/modes");
    std::istringstream words(modes);
    std::string list;
    for (std::string mode; words >> mode;) list += " " + mode;
    text += fmt::format("{}: {}, {}, modes{}\n", name, firstLine(folder + name + "/status"),
                        firstLine(folder + name + "/enabled"), list.empty() ? " none" : list);
  }
  return text;
}

std::string pciText(const std::string& root) {
  std::string text;
  const std::string folder = root + "/sys/bus/pci/devices/";
  for (const std::string& name : namesIn(folder)) {
    const std::string at = folder + name;
    text +=
        fmt::format("{}: class {}, id {}:{}, driver {}\n", name, firstLine(at + "/class"),
                    firstLine(at + "/vendor"), firstLine(at + "/device"), linkName(at + "/driver"));
  }
  return text;
}

std::string usbText(const std::string& root) {
  std::string text;
  const std::string folder = root + "/sys/bus/usb/devices/";
  for (const std::string& name : namesIn(folder)) {
    const std::string at = folder + name;
    const std::string vendor = firstLine(at + "/idVendor");
    if (vendor.empty()) continue;  // an entry without a vendor is an interface, not a device
    text += fmt::format("{}: id {}:{}, {} {}, {} Mbit/s\n", name, vendor,
                        firstLine(at + "/idProduct"), firstLine(at + "/manufacturer"),
                        firstLine(at + "/product"), firstLine(at + "/speed"));
  }
  return text;
}

std::string serialText(const std::string& root) {
  std::string text;
  const std::string folder = root + "/dev/serial/by-id/";
  for (const std::string& name : namesIn(folder))
    text += fmt::format("{} -> {}\n", oneLine(name), linkName(folder + name));
  return text;
}

// Returns the names and event devices of keyboards, mice and other input devices.
std::string inputText(const std::string& root) {
  std::string text;
  std::istringstream lines(contentOf(root + "/proc/bus/input/devices"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("N: ") || line.starts_with("H: ")) text += line.substr(3) + "\n";
  }
  return text;
}

std::string kernelText(const std::string& root) {
  const std::string at = root + "/proc/sys/kernel/";
  return fmt::format("{} {} {}", firstLine(at + "ostype"), firstLine(at + "osrelease"),
                     firstLine(at + "version"));
}

}  // namespace

std::string versionsText(const std::string& root) {
  return fmt::format("merlin {}\nkernel {}\ndistribution {}\n", programVersion(), kernelText(root),
                     valueOf(contentOf(root + "/etc/os-release"), "PRETTY_NAME", '='));
}

std::string librariesText(const std::string& root, const std::string& pid) {
  std::set<std::string> libraries;
  std::istringstream lines(contentOf(fmt::format("{}/proc/{}/maps", root, pid)));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t name = line.find('/');
    if (name != std::string::npos && line.find(".so", name) != std::string::npos)
      libraries.insert(oneLine(line.substr(name)));
  }
  std::string text;
  for (const std::string& library : libraries) text += library + "\n";
  return text;
}

std::string hardwareText(const std::string& root) {
  const std::pair<const char*, std::string> sections[] = {
      {"CPU", cpuText(root)},
      {"Memory", memoryText(root)},
      {"File systems", disksText(root)},
      {"Graphics cards", cardsText(root)},
      {"Connectors and displays", connectorsText(root)},
      {"PCI devices", pciText(root)},
      {"USB devices", usbText(root)},
      {"Serial adapters by id", serialText(root)},
      {"Input devices", inputText(root)}};
  std::string text;
  for (const auto& [title, lines] : sections)
    text += fmt::format("{}:\n{}\n", title, lines.empty() ? "none is found\n" : lines);
  return text;
}

std::vector<PackedFile> displayIds(const std::string& root) {
  std::vector<PackedFile> ids;
  const std::string folder = root + "/sys/class/drm/";
  for (const std::string& name : namesIn(folder)) {
    std::string id = contentOf(folder + name + "/edid");
    if (!id.empty()) ids.push_back({name + ".edid", std::move(id)});
  }
  return ids;
}

}  // namespace merlin::cli
