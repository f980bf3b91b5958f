// SpnavServer: MERLIN's ball for programs that know a space mouse, on the socket that libspnav
// opens.
#pragma once

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/serve/spnav_protocol.h"
#include "daemon/shm/layout.h"

namespace merlin::serve {

// Owns its thread; reads the segment as any client does, so that a slow program delays nobody.
class SpnavServer {
 public:
  // Errors: kBusy (spacenavd, or another, answers on that socket), kIo. A socket that nobody
  // answers on is replaced. `segment` outlives this.
  static Result<std::unique_ptr<SpnavServer>> start(const std::string& socket_path,
                                                    const SpnavDevice& device,
                                                    const shm::DevicesSegment& segment);
  ~SpnavServer();  // removes the socket
  SpnavServer(const SpnavServer&) = delete;
  SpnavServer& operator=(const SpnavServer&) = delete;

 private:
  struct Client {
    UniqueFd fd;
    SpnavClient protocol;
    std::string pending;  // what it has not taken yet
  };
  SpnavServer(std::string path, UniqueFd listener, SpnavDevice device,
              const shm::DevicesSegment& segment);
  void run(const std::stop_token& stop);
  void acceptClients();
  void tellSamples();
  void tellHealth();
  // Reads and writes; false once the client is gone.
  static bool serve(Client& client);

  std::string path_;
  UniqueFd listener_;
  SpnavDevice device_;
  const shm::DevicesSegment& segment_;
  std::vector<Client> clients_;
  std::uint64_t seen_ = 0;  // samples of the ball
  bool there_ = false;
  std::jthread thread_;
};

}  // namespace merlin::serve
