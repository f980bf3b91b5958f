#include "daemon/cli/report/part.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/unique_fd.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMissingBytes = 65536;  // limit for the sentences of a part
constexpr int kExitNotInstalled = 127;

// A folder that only this user can read; the destructor removes it.
class PrivateFolder {
 public:
  static Result<PrivateFolder> make() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "merlin-report-XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr)
      return Error{Errc::kIo, fmt::format("{}: {}", name, std::strerror(errno))};
    return PrivateFolder(std::move(name));
  }
  ~PrivateFolder() {
    std::error_code error;
    if (!path_.empty()) fs::remove_all(path_, error);
  }
  PrivateFolder(PrivateFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  explicit PrivateFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

// Prepares the child process: it discards what the part prints, and limits the size of each file,
// so that writing beyond the limit fails.
void limitChild(std::size_t most_bytes, const sigset_t& mask) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::sigprocmask(SIG_SETMASK, &mask, nullptr);
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit size{};
  ::getrlimit(RLIMIT_FSIZE, &size);
  size.rlim_cur = std::min<rlim_t>(most_bytes, size.rlim_max);
  ::setrlimit(RLIMIT_FSIZE, &size);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, fd);
}

[[noreturn]] void collectInChild(const PartSettings& part, const std::string& path, int to,
                                 const sigset_t& mask) {
  limitChild(part.most_bytes, mask);
  PartFolder folder(path);
  try {
    part.collect(folder);
  } catch (const std::exception& e) {
    folder.lacks(fmt::format("{}: {}", part.name, e.what()));
  }
  std::string text;
  for (const std::string& what : folder.missing()) text += oneLine(what) + '\n';
  // Limits the text to about the capacity of a pipe.
  text.resize(std::min(text.size(), kMostMissingBytes));
  // The zero byte marks that the part is complete.
  text += '\0';
  const ssize_t told = ::write(to, text.data(), text.size());
  ::_exit(told < 0 ? 1 : 0);
}

// The text that the child has sent until it ended. `late`: whether its time was over before;
// `stopped`: whether a signal came before.
struct ProgramOutput {
  std::string text;
  bool late = false, stopped = false;
};
ProgramOutput listen(int from, int stop, Timestamp until) {
  const SystemClock clock;
  ProgramOutput told;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - clock.now()).count();
    if (left <= 0) return told.late = true, told;
    std::array<pollfd, 2> items{pollfd{from, POLLIN, 0}, pollfd{stop, POLLIN, 0}};
    ::poll(items.data(), items.size(), static_cast<int>(left));
    if (items[1].revents != 0) return told.stopped = true, told;
    if (items[0].revents == 0) continue;
    std::array<char, 4096> bytes{};
    const ssize_t n = ::read(from, bytes.data(), bytes.size());
    if (n > 0) told.text.append(bytes.data(), static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EINTR)) return told;
  }
}

// Kills the child and the programs that it has started, and waits up to one second for its end,
// because a process that waits for a device may not end at once.
void endChild(pid_t child) {
  ::kill(-child, SIGKILL);
  ::kill(child, SIGKILL);
  const SystemClock clock;
  for (const Timestamp until = clock.now() + std::chrono::seconds(1); clock.now() < until;) {
    const pid_t ended = ::waitpid(child, nullptr, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) return;
    ::poll(nullptr, 0, 5);
  }
}

void takeFiles(const PartSettings& part, const std::string& path, PartResult& result) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::size_t left = part.most_bytes;
  for (const fs::path& file : paths) {
    const std::string name = (part.in_folder ? part.name + "/" : "") + file.filename().string();
    const auto stamp = fileStamp(file.string());
    const auto content = stamp && stamp->size <= left ? FileCopy::read(file.string(), left)
                                                      : Result<FileCopy>(Error{Errc::kIo, ""});
    if (!content) {
      result.missing.push_back(fmt::format(
          "{}: does not fit: the files of this part may have {} bytes", name, part.most_bytes));
      continue;
    }
    left -= content->bytes().size();
    result.files.push_back({name, std::string(content->text())});
  }
}

void takeMissing(std::string_view text, PartResult& result) {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    result.missing.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::string PartFolder::path(const std::string& name) const {
  std::string safe = oneLine(name);
  std::replace(safe.begin(), safe.end(), '/', '_');
  if (safe.empty() || safe[0] == '.') safe.insert(0, "_");
  return path_ + "/" + safe;
}

void PartFolder::put(const std::string& name, const Result<std::string>& content) {
  if (!content) return lacks(fmt::format("{}: {}", name, content.error().what));
  if (const auto written = writeFile(path(name), *content); !written)
    lacks(fmt::format("{}: {}", name, written.error().what));
}

void PartFolder::copy(const std::string& from, std::size_t most) {
  const std::string name = fs::path(from).filename().string();
  const auto stamp = fileStamp(from);
  if (stamp && stamp->size > most)
    return lacks(fmt::format("{}: has {} bytes; at most {} are taken", from, stamp->size, most));
  const auto content = FileCopy::read(from, most);
  put(name, content ? Result<std::string>(std::string(content->text()))
                    : Result<std::string>(content.error()));
}

Result<PartResult> runPart(const PartSettings& part, int stop, const sigset_t& mask) {
  const auto folder = PrivateFolder::make();
  if (!folder) return folder.error();
  auto pipe = makePipe();
  if (!pipe) return pipe.error();
  std::fflush(nullptr);  // otherwise the child would write the buffered output a second time
  const auto child = startChild();
  if (!child) return child.error();
  if (*child == 0) collectInChild(part, folder->path(), pipe->to.get(), mask);
  pipe->to.reset();
  const ProgramOutput told = listen(pipe->from.get(), stop, SystemClock().now() + part.limit);
  endChild(*child);
  if (told.stopped) return Error{Errc::kClosed, "interrupted; nothing is left behind"};
  PartResult result;
  takeMissing(told.text, result);
  if (told.late) {
    result.missing.push_back(fmt::format("{}: was ended after {:.0f} s, before it was complete",
                                         part.name, toSeconds(part.limit)));
  } else if (!told.text.ends_with('\0')) {
    result.missing.push_back(part.name + ": the process that collects it ended early");
  }
  takeFiles(part, folder->path(), result);
  return result;
}

Result<int> runInto(const std::string& path, const std::vector<std::string>& arguments) {
  const UniqueFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  if (!file.valid()) return Error{Errc::kIo, fmt::format("{}: {}", path, std::strerror(errno))};
  std::vector<std::string> copies = arguments;
  std::vector<char*> argv;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const auto child = startChild();
  if (!child) return child.error();
  if (*child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::dup2(file.get(), STDOUT_FILENO);
    ::dup2(file.get(), STDERR_FILENO);
    ::setenv("LC_ALL", "C.UTF-8", 1);  // NOLINT(concurrency-mt-unsafe): one thread
    ::execvp(argv[0], argv.data());
    ::_exit(kExitNotInstalled);
  }
  const int status = waitForChild(*child);
  if (!WIFEXITED(status))
    return Error{Errc::kIo,
                 fmt::format("{} was ended by signal {}", arguments[0], WTERMSIG(status))};
  if (WEXITSTATUS(status) != kExitNotInstalled) return WEXITSTATUS(status);
  ::unlink(path.c_str());
  return Error{Errc::kNotFound, fmt::format("the program {} is not installed", arguments[0])};
}

}  // namespace merlin::cli
