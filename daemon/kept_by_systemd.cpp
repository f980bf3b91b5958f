#include "daemon/kept_by_systemd.h"

#include <cstdlib>
#include <utility>

#include <fcntl.h>
#include <systemd/sd-daemon.h>

namespace merlin {

KeptBySystemd::KeptBySystemd()
    : is_service_(std::getenv("NOTIFY_SOCKET") != nullptr) {  // NOLINT(concurrency-mt-unsafe)
  char** names = nullptr;
  const int count = ::sd_listen_fds_with_names(1, &names);
  for (int i = 0; i < count; ++i) {
    UniqueFd file(SD_LISTEN_FDS_START + i);
    taken_over_.insert_or_assign(names[i], std::move(file));
    std::free(names[i]);  // NOLINT(cppcoreguidelines-no-malloc): systemd's
  }
  std::free(names);  // NOLINT(cppcoreguidelines-no-malloc)
}

UniqueFd KeptBySystemd::take(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = taken_over_.find(name);
  if (found == taken_over_.end()) return {};
  UniqueFd file = std::move(found->second);
  taken_over_.erase(found);
  return file;
}

bool KeptBySystemd::keep(const std::string& name, int fd) {
  if (!is_service_) return false;
  removeFromStore(name);  // systemd would keep both files under the same name
  const std::string message = "FDSTORE=1\nFDNAME=" + name;
  if (::sd_pid_notify_with_fds(0, 0, message.c_str(), &fd, 1) <= 0) return false;
  const std::lock_guard lock(mutex_);
  kept_.insert_or_assign(name, UniqueFd(::fcntl(fd, F_DUPFD_CLOEXEC, 0)));
  return true;
}

void KeptBySystemd::forget(const std::string& name) {
  if (is_service_) removeFromStore(name);
  const std::lock_guard lock(mutex_);
  kept_.erase(name);
}

std::vector<std::pair<std::string, UniqueFd>> KeptBySystemd::handOver() {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<std::string, UniqueFd>> files;
  for (auto& [name, file] : std::exchange(kept_, {})) files.emplace_back(name, std::move(file));
  return files;
}

void KeptBySystemd::forgetUntaken() {
  const std::lock_guard lock(mutex_);
  for (const auto& [name, file] : taken_over_) removeFromStore(name);
  taken_over_.clear();
}

void KeptBySystemd::removeFromStore(const std::string& name) const {
  ::sd_notify(0, ("FDSTOREREMOVE=1\nFDNAME=" + name).c_str());
}

}  // namespace merlin
