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
  // Forgets what the process before this one kept and nobody has taken: a card that is not used any
  // more would show its last picture for ever.
  void forgetUntaken();
  // What is kept, by name, for ProgramRestart: the service goes on, so that systemd hands over
  // nothing.
  std::vector<std::pair<std::string, UniqueFd>> handOver();

 private:
  void removeFromStore(const std::string& name) const;

  const bool is_service_;
  std::mutex mutex_;
  std::map<std::string, UniqueFd> taken_over_;
  std::map<std::string, UniqueFd> kept_;  // copies
};

}  // namespace merlin
