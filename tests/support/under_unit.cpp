// under_unit [--in FOLDER] UNIT... -- PROGRAM ARGUMENT...: runs a program, without systemd, under
// some restrictions of the given systemd unit files: address families, system calls, no new
// privileges, umask. Started by root, it runs the program as the user nobody. Later files add to
// earlier ones, as systemd's drop-ins do. FOLDER stands for the root of the file system, which
// ProtectSystem=strict makes read-only except for $STATE_DIRECTORY and ReadWritePaths= (for example
// FOLDER/srv for /srv); only root can use --in. All other settings of the units are ignored.
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <grp.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stddef.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

using Words = std::vector<std::string>;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "under_unit: %s\n", what.c_str());
  std::exit(99);
}

std::string outputOf(const char* command) {
  std::string text;
  FILE* const pipe = ::popen(command, "r");
  if (!pipe) return text;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    text.append(buffer, n);
  ::pclose(pipe);
  return text;
}

// Returns all values of `key` from all files. An assignment without a value removes the values
// before it, as in systemd for a key whose value is a list.
Words valuesOf(const Words& units, const std::string& key) {
  Words values;
  for (const std::string& unit : units) {
    std::ifstream file(unit);
    if (!file) fail(unit + ": cannot be read");
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with(key + "=")) continue;
      std::istringstream words(line.substr(key.size() + 1));
      if ((words >> std::ws).eof()) values.clear();
      for (std::string word; words >> word;) values.push_back(word);
    }
  }
  return values;
}

bool isYes(const Words& values) { return !values.empty() && values.back() == "yes"; }

// Returns whether systemd would set no_new_privs for these units: without it, a process without
// privileges cannot install seccomp filters (systemd.exec(5), NoNewPrivileges=).
bool hasNoNewPrivileges(const Words& units) {
  for (const char* const key :
       {"NoNewPrivileges", "RestrictRealtime", "RestrictSUIDSGID", "LockPersonality",
        "MemoryDenyWriteExecute", "PrivateDevices", "ProtectKernelTunables", "ProtectKernelModules",
        "ProtectKernelLogs", "ProtectClock", "ProtectHostname", "RestrictNamespaces"}) {
    if (isYes(valuesOf(units, key))) return true;
  }
  for (const char* const key :
       {"SystemCallFilter", "SystemCallArchitectures", "RestrictAddressFamilies"}) {
    if (!valuesOf(units, key).empty()) return true;
  }
  return false;
}

std::uint32_t familyOf(const std::string& name) {
  static const std::map<std::string, std::uint32_t> kFamilies = {{"AF_UNIX", AF_UNIX},
                                                                 {"AF_INET", AF_INET},
                                                                 {"AF_INET6", AF_INET6},
                                                                 {"AF_NETLINK", AF_NETLINK}};
  const auto found = kFamilies.find(name);
  if (found == kFamilies.end()) fail(name + ": is not an address family known to under_unit");
  return found->second;
}

// Returns the names of the system calls in `sets`, from systemd's own tables; empty if systemd is
// not installed.
std::set<std::string> callsOf(const Words& sets) {
  std::map<std::string, Words> table;
  std::istringstream lines(outputOf("systemd-analyze syscall-filter 2>/dev/null"));
  std::string current;
  for (std::string line; std::getline(lines, line);) {
    const auto from = line.find_first_not_of(' ');
    if (from == std::string::npos || line[from] == '#') continue;
    if (from == 0)
      current = line;
    else
      table[current].push_back(line.substr(from));
  }
  const auto expanded = [&](Words open) {
    std::set<std::string> calls, seen;
    while (!open.empty() && !table.empty()) {
      const std::string name = open.back();
      open.pop_back();
      if (!seen.insert(name).second) continue;
      if (name[0] == '@')
        open.insert(open.end(), table[name].begin(), table[name].end());
      else
        calls.insert(name);
    }
    return calls;
  };
  Words allowed, forbidden;
  for (const std::string& name : sets)
    name[0] == '~' ? forbidden.push_back(name.substr(1)) : allowed.push_back(name);
  std::set<std::string> calls = expanded(allowed);
  for (const std::string& name : expanded(forbidden)) calls.erase(name);
  return calls;
}

std::set<std::uint32_t> numbersOf(const std::set<std::string>& calls) {
  std::set<std::uint32_t> numbers;
  std::istringstream lines(outputOf("echo '#include <sys/syscall.h>' | cc -E -dM - 2>/dev/null"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string define, name;
    std::uint32_t number = 0;
    if (!(words >> define >> name >> number) || !name.starts_with("__NR_")) continue;
    if (calls.count(name.substr(5)) > 0) numbers.insert(number);
  }
  return numbers;
}

void install(const std::vector<sock_filter>& code) {
  sock_fprog program{static_cast<unsigned short>(code.size()),
                     const_cast<sock_filter*>(code.data())};
  if (::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) fail("no seccomp filter");
}

constexpr std::uint16_t kLoad = BPF_LD | BPF_W | BPF_ABS;
constexpr std::uint16_t kEqual = BPF_JMP | BPF_JEQ | BPF_K;
constexpr std::uint16_t kReturn = BPF_RET | BPF_K;

// Like systemd's RestrictAddressFamilies=: socket() with another family fails with EAFNOSUPPORT.
void restrictFamilies(const Words& names) {
  if (names.empty()) return;
  std::vector<sock_filter> code = {
      BPF_STMT(kLoad, offsetof(seccomp_data, nr)), BPF_JUMP(kEqual, SYS_socket, 1, 0),
      BPF_STMT(kReturn, SECCOMP_RET_ALLOW), BPF_STMT(kLoad, offsetof(seccomp_data, args))};
  for (const std::string& name : names) {
    code.push_back(BPF_JUMP(kEqual, familyOf(name), 0, 1));
    code.push_back(BPF_STMT(kReturn, SECCOMP_RET_ALLOW));
  }
  code.push_back(BPF_STMT(kReturn, SECCOMP_RET_ERRNO | EAFNOSUPPORT));
  install(code);
}

// Like systemd's SystemCallFilter=: a system call that `sets` do not allow kills the process, or
// fails with EPERM if `error` (the unit's SystemCallErrorNumber=) is EPERM.
void restrictCalls(const Words& sets, const Words& error) {
  if (sets.empty()) return;
  if (!error.empty() && error.back() != "EPERM")
    fail(error.back() + ": is not known to under_unit");
  const auto numbers = numbersOf(callsOf(sets));
  if (numbers.size() < 100) {
    std::fprintf(stderr, "under_unit: no table of system calls; they are not restricted\n");
    return;
  }
  std::vector<sock_filter> code = {BPF_STMT(kLoad, offsetof(seccomp_data, nr))};
  for (const std::uint32_t number : numbers) {
    code.push_back(BPF_JUMP(kEqual, number, 0, 1));
    code.push_back(BPF_STMT(kReturn, SECCOMP_RET_ALLOW));
  }
  code.push_back(
      BPF_STMT(kReturn, error.empty() ? SECCOMP_RET_KILL_PROCESS : SECCOMP_RET_ERRNO | EPERM));
  install(code);
}

void mountOrFail(const std::string& from, const std::string& at, unsigned long flags) {
  if (::mount(from.empty() ? nullptr : from.c_str(), at.c_str(), nullptr, flags, nullptr) != 0)
    fail(at + ": cannot be mounted: " + std::strerror(errno));
}

// Like systemd's ProtectSystem=strict and ReadWritePaths=, applied to the file tree under `folder`.
void restrictFiles(const std::string& folder, const Words& units) {
  const Words strict = valuesOf(units, "ProtectSystem");
  if (folder.empty() || strict.empty() || strict.back() != "strict") return;
  Words writable;
  if (const char* const state = std::getenv("STATE_DIRECTORY")) writable.emplace_back(state);
  for (const std::string& path : valuesOf(units, "ReadWritePaths"))
    writable.push_back(folder + path);
  if (::unshare(CLONE_NEWNS) != 0) fail("no mount namespace");
  mountOrFail("", "/", MS_REC | MS_PRIVATE);
  mountOrFail(folder, folder, MS_BIND);
  mountOrFail("", folder, MS_BIND | MS_REMOUNT | MS_RDONLY);
  for (const std::string& path : writable) {
    mountOrFail(path, path, MS_BIND);
    mountOrFail("", path, MS_BIND | MS_REMOUNT);
  }
}

// LeakSanitizer inspects the ending program with ptrace, which a unit forbids; the program and the
// sanitizer would then hang.
void doWithoutLeakSanitizer() {
  const char* const options = std::getenv("ASAN_OPTIONS");
  ::setenv("ASAN_OPTIONS", (std::string(options ? options : "") + ":detect_leaks=0").c_str(), 1);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr unsigned kNobody = 65534;
  Words units;
  const std::string folder = argc > 2 && std::string(argv[1]) == "--in" ? argv[2] : "";
  int at = folder.empty() ? 1 : 3;
  for (; at < argc && std::string(argv[at]) != "--"; ++at) units.emplace_back(argv[at]);
  if (at + 1 >= argc || units.empty())
    fail("usage: under_unit [--in FOLDER] UNIT... -- PROGRAM ARGUMENT...");
  const Words families = valuesOf(units, "RestrictAddressFamilies");
  const Words sets = valuesOf(units, "SystemCallFilter");
  const Words error = valuesOf(units, "SystemCallErrorNumber");
  const bool no_new_privileges = hasNoNewPrivileges(units);
  restrictFiles(folder, units);
  for (const std::string& mask : valuesOf(units, "UMask"))
    ::umask(static_cast<mode_t>(std::strtoul(mask.c_str(), nullptr, 8)));
  if (::geteuid() == 0 &&
      (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) {
    fail("cannot become nobody");
  }
  // The kernel clears the parent-death signal at a change of user, so it is set again here.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (no_new_privileges && ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
    fail("no PR_SET_NO_NEW_PRIVS");
  doWithoutLeakSanitizer();
  restrictFamilies(families);
  restrictCalls(sets, error);
  ::execv(argv[at + 1], argv + at + 1);
  fail(std::string(argv[at + 1]) + ": cannot be executed");
}
