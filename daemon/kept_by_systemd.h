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
  // Takes over what systemd handed to this process. To be made before any process is forked, once:
  // the environment says nothing of it afterwards.
  KeptBySystemd();

  UniqueFd take(const std::string& name) override;
  bool keep(const std::string& name, int fd) override;
  void forget(const std::string& name) override;
  // Forgets the files that the previous process kept and that nobody has taken, since a graphics
  // card that is no longer used would otherwise show its last picture for ever.
  void forgetUntaken();
  // Returns the kept files, by name, for ProgramRestart: since the service goes on, systemd hands
  // over nothing.
  std::vector<std::pair<std::string, UniqueFd>> handOver();

 private:
  void removeFromStore(const std::string& name) const;

  const bool is_service_;
  std::mutex mutex_;
  std::map<std::string, UniqueFd> taken_over_;
  std::map<std::string, UniqueFd> kept_;  // copies
};

}  // namespace merlin
