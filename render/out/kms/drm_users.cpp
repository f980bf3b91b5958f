#include "render/out/kms/drm_users.h"

#include <charconv>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>
#include <xf86drm.h>

namespace merlin::render::out::kms {
namespace {

namespace fs = std::filesystem;

// Returns the numbers of the descriptors by which a process has the file open. `process`: its
// folder in /proc.
std::vector<int> descriptorsOf(const fs::path& process, const std::string& path) {
  std::vector<int> descriptors;
  std::error_code ignored;
  for (const auto& open : fs::directory_iterator(process / "fd", ignored)) {
    if (fs::read_symlink(open.path(), ignored) != path) continue;
    const std::string name = open.path().filename();
    int number = -1;
    std::from_chars(name.data(), name.data() + name.size(), number);
    descriptors.push_back(number);
  }
  return descriptors;
}

}  // namespace

std::vector<std::string> programsWith(const std::string& path) {
  std::vector<std::string> programs;
  std::error_code ignored;
  for (const auto& process : fs::directory_iterator("/proc", ignored)) {
    const std::string pid = process.path().filename();
    const bool is_process = pid.find_first_not_of("0123456789") == std::string::npos;
    // The parent is the service manager, which keeps the card's file.
    if (!is_process || pid == std::to_string(::getpid()) || pid == std::to_string(::getppid()))
      continue;
    if (descriptorsOf(process.path(), path).empty()) continue;
    const fs::path program = fs::read_symlink(process.path() / "exe", ignored);
    programs.push_back(fmt::format("{} ({})", program.filename().string(), pid));
  }
  return programs;
}

void dropMasterElsewhere(const std::string& path, int fd) {
  for (const int other : descriptorsOf("/proc/self", path)) {
    if (other != fd) drmDropMaster(other);
  }
}

}  // namespace merlin::render::out::kms
