#include "daemon/import/sandbox.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <iterator>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include "daemon/base/sanitizer.h"
#include "daemon/base/unique_fd.h"

namespace merlin::import {
namespace {

Result<Ok> limit(decltype(RLIMIT_AS) what, std::uint64_t most, const char* name) {
  rlimit now{};
  ::getrlimit(what, &now);
  const rlim_t value = std::min<rlim_t>(most, now.rlim_max);
  const rlimit both{value, value};
  if (::setrlimit(what, &both) == 0) return Ok{};
  return Error{Errc::kIo,
               fmt::format("the limit of {} cannot be set: {}", name, std::strerror(errno))};
}

// File accesses of Landlock's first version.
constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWrite =
    LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE;
constexpr std::uint64_t kAll = (std::uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1) - 1;

bool allow(int rules, const std::string& path, std::uint64_t access) {
  const UniqueFd at(::open(path.c_str(), O_PATH | O_CLOEXEC));
  if (!at.valid()) return false;
  landlock_path_beneath_attr beneath{};
  beneath.allowed_access = access;
  beneath.parent_fd = at.get();
  return ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) == 0;
}

// Limits file access to the inputs (read-only), the folder, and the system files that libraries
// read.
bool limitFiles(const std::vector<std::string>& inputs, const std::string& folder) {
  landlock_ruleset_attr all{};
  all.handled_access_fs = kAll;
  const UniqueFd rules(
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &all, sizeof all, 0)));
  if (!rules.valid()) return false;
  if (!allow(rules.get(), folder, kRead | kWrite)) return false;
  for (const std::string& input : inputs) {
    if (!allow(rules.get(), input, LANDLOCK_ACCESS_FS_READ_FILE) && input == inputs.front())
      return false;
  }
  for (const char* system : {"/usr", "/lib", "/lib64", "/proc", "/sys/devices/system/cpu"})
    allow(rules.get(), system, kRead);
  for (const char* device : {"/dev/null", "/dev/urandom"})
    allow(rules.get(), device, LANDLOCK_ACCESS_FS_READ_FILE);
  return ::syscall(SYS_landlock_restrict_self, rules.get(), 0) == 0;
}

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;
#endif

// System calls that fail in the sandbox: those that concern the network, other programs and
// processes, or the kernel.
constexpr int kForbidden[] = {SYS_socket,
                              SYS_socketpair,
                              SYS_connect,
                              SYS_bind,
                              SYS_listen,
                              SYS_accept,
                              SYS_accept4,
                              SYS_sendto,
                              SYS_sendmsg,
                              SYS_execve,
                              SYS_execveat,
                              SYS_ptrace,
                              SYS_kill,
                              SYS_process_vm_readv,
                              SYS_process_vm_writev,
                              SYS_mount,
                              SYS_umount2,
                              SYS_pivot_root,
                              SYS_chroot,
                              SYS_unshare,
                              SYS_setns,
                              SYS_bpf,
                              SYS_perf_event_open,
                              SYS_add_key,
                              SYS_request_key,
                              SYS_keyctl,
                              SYS_init_module,
                              SYS_finit_module,
                              SYS_io_uring_setup,
                              SYS_userfaultfd,
                              SYS_open_by_handle_at,
                              SYS_shmget,
                              SYS_memfd_secret};

// Sets a filter of system calls; a call with the number of another architecture ends the process.
bool limitCalls() {
  if (kMachine == 0) return false;
  constexpr std::uint32_t kOtherNumbers = 0x4000'0000;  // x32
  std::vector<sock_filter> filter = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kOtherNumbers, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
  };
  for (const int call : kForbidden) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0;
}

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 4096;

bool isHidden(const fs::directory_entry& entry) {
  return entry.path().filename().string().starts_with('.');
}

// Adds the visible files of a folder.
void addFiles(const fs::path& folder, std::vector<std::string>& files) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (files.size() >= kMostFiles) return;
    if (!isHidden(entry) && entry.is_regular_file(error)) files.push_back(entry.path().string());
  }
}

constexpr const char* kUsualFolders[] = {"textures", "Textures", "images", "maps", "materials"};

// Returns the visible folders in a folder. The usual ones come first, in case there are too many
// files. A link to a folder counts only under a usual name, because an unpacked model may contain
// links to anywhere.
std::vector<fs::path> foldersIn(const fs::path& folder) {
  constexpr std::size_t kMostLooked = 65536;
  std::vector<fs::path> folders, others;
  for (const char* name : kUsualFolders) folders.push_back(folder / name);
  std::error_code error;
  std::size_t looked = 0;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (++looked > kMostLooked) break;
    const bool usual = std::ranges::find(folders, entry.path()) != folders.end();
    if (!usual && !isHidden(entry) && !entry.is_symlink(error) && entry.is_directory(error))
      others.push_back(entry.path());
  }
  std::ranges::sort(others);
  folders.insert(folders.end(), others.begin(), others.end());
  return folders;
}

}  // namespace

std::vector<std::string> filesBeside(const std::string& input) {
  std::vector<std::string> files;
  const auto folder = std::filesystem::absolute(input).parent_path();
  addFiles(folder, files);
  for (const auto& inside : foldersIn(folder)) addFiles(inside, files);
  return files;
}

Result<Ok> limitFileSize(std::uint64_t bytes) {
  ::signal(SIGXFSZ, SIG_IGN);  // exceeding the limit is then an error of write()
  return limit(RLIMIT_FSIZE, bytes, "file sizes");
}

Result<std::vector<std::string>> closeSandbox(const std::vector<std::string>& inputs,
                                              const std::string& folder, const Limits& limits) {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
    return Error{Errc::kIo, fmt::format("PR_SET_NO_NEW_PRIVS: {}", std::strerror(errno))};
#if !defined(MERLIN_ANY_SANITIZER)  // sanitizers reserve terabytes
  if (const auto set = limit(RLIMIT_AS, limits.memory_bytes, "memory"); !set) return set.error();
#endif
  if (const auto set = limit(RLIMIT_CPU, limits.cpu_s, "CPU time"); !set) return set.error();
  if (const auto set = limit(RLIMIT_CORE, 0, "core dumps"); !set) return set.error();
  if (const auto set = limit(RLIMIT_NOFILE, 128, "open files"); !set) return set.error();
  ::unshare(CLONE_NEWNET);  // if it is not allowed, limitCalls() forbids the network
  std::vector<std::string> lacking;
  if (!limitFiles(inputs, folder)) lacking.emplace_back("Landlock, which limits files");
  if (!limitCalls()) lacking.emplace_back("seccomp, which limits the network and other programs");
  return lacking;
}

}  // namespace merlin::import
