// KeptBySystemd: open files in the descriptor store of systemd (FileDescriptorStoreMax= of the
// unit), which hands them to the next process of the service.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/kept_files.h"

namespace merlin {

class KeptBySystemd final : public KeptFiles {
 public:
  // Takes over the files that systemd passed to this process, and removes the environment variables
  // (LISTEN_FDS and others) that describe them. REQUIRES: this is the only object of the class, and
  // no process has been forked yet.
  KeptBySystemd();

  UniqueFd take(const std::string& name) override;
  bool keep(const std::string& name, int fd) override;
  void forget(const std::string& name) override;
  // Removes from systemd's store the files that the previous process kept and that were not taken
  // with take(). Otherwise a graphics card that is no longer used would show its last picture
  // forever.
  void forgetUntaken();
  // Returns the kept files and their names, for ProgramRestart::now(). A restart within the process
  // needs them, because systemd passes its store only to a new process.
  std::vector<std::pair<std::string, UniqueFd>> handOver();

 private:
  void removeFromStore(const std::string& name) const;

  const bool is_service_;
  std::mutex mutex_;
  std::map<std::string, UniqueFd> taken_over_;
  std::map<std::string, UniqueFd> kept_;  // duplicates of the descriptors in the store
};

}  // namespace merlin
