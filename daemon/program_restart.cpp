#include "daemon/program_restart.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace merlin {
namespace {

constexpr int kFirst = SD_LISTEN_FDS_START;  // the first descriptor after standard error
constexpr const char* kProgram = "/proc/self/exe";

std::vector<int> openFiles() {
  std::vector<int> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename().string();
    int fd = -1;
    std::from_chars(name.data(), name.data() + name.size(), fd);
    if (fd >= kFirst) files.push_back(fd);
  }
  return files;
}

// Makes the kernel close these files when the new program begins.
void closeAtStart(const std::vector<int>& files) {
  for (const int fd : files) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

// Gives the files the numbers from kFirst on, and leaves them open for the new program.
void place(const std::vector<std::pair<std::string, UniqueFd>>& kept) {
  std::vector<UniqueFd> apart;  // copies: a number may still be in use by another file
  const int beyond = kFirst + static_cast<int>(kept.size());
  for (const auto& [name, file] : kept)
    apart.emplace_back(::fcntl(file.get(), F_DUPFD_CLOEXEC, beyond));
  for (std::size_t i = 0; i < apart.size(); ++i)
    ::dup2(apart[i].get(), kFirst + static_cast<int>(i));
}

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

ProgramRestart::ProgramRestart(int argc, char** argv) : arguments_(argv, argv + argc) {
  // The kernel names a process after the path that is executed: after now(), ps would show "exe".
  ::prctl(PR_SET_NAME, program_invocation_short_name);
  for (char** variable = environ; *variable; ++variable) {
    if (!std::string_view(*variable).starts_with("LISTEN_")) environment_.emplace_back(*variable);
  }
}

Error ProgramRestart::now(const std::vector<std::pair<std::string, UniqueFd>>& kept) const {
  std::vector<std::string> arguments = arguments_, environment = environment_;
  if (!kept.empty()) {
    std::string names;
    for (const auto& [name, file] : kept) names += (names.empty() ? "" : ":") + name;
    environment.push_back(fmt::format("LISTEN_PID={}", ::getpid()));
    environment.push_back(fmt::format("LISTEN_FDS={}", kept.size()));
    environment.push_back("LISTEN_FDNAMES=" + names);
  }
  ::alarm(0);  // an alarm that is set would end the new program
  closeAtStart(openFiles());
  place(kept);
  ::execve(kProgram, pointersTo(arguments).data(), pointersTo(environment).data());
  return {Errc::kIo,
          fmt::format("merlind cannot be started again: {}: {}", kProgram, std::strerror(errno))};
}

}  // namespace merlin
