// SpnavServer: MERLIN's ball for programs that know a space mouse, on the socket that libspnav
// opens.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/net/server_thread.h"
#include "daemon/serve/sample_waker.h"
#include "daemon/serve/spnav_protocol.h"
#include "daemon/shm/layout.h"

namespace merlin::serve {

// Owns its threads; reads the segment as any client does, so that a slow program delays nobody.
//
// libspnav takes whatever comes after a question for its answer. So a client hears no event from
// its connection, or a question, until it has been silent for a moment (60 ms; 0.5 s for one that
// asks all the time): then it hears which buttons changed, and the newest motion.
class SpnavServer final : public net::Server {
 public:
  // Errors: listenLocal()'s. `segment`, `watch` and `clock` outlive this.
  static Result<std::unique_ptr<SpnavServer>> start(const std::string& socket_path,
                                                    const shm::DevicesSegment& segment,
                                                    ThreadWatch& watch, const Clock& clock);
  ~SpnavServer() override;  // removes the socket
  SpnavServer(const SpnavServer&) = delete;
  SpnavServer& operator=(const SpnavServer&) = delete;

  net::ServerReport report() const override { return server_.report(); }
  std::string failure() const override { return thread_.failure(); }

 private:
  SpnavServer(std::string path, UniqueFd listener, const shm::DevicesSegment& segment,
              ThreadWatch& watch, const Clock& clock);
  void round();
  void listen(UniqueFd listener);
  void listenAgainWhereGone();
  void tellSamples();
  void tellMissed();
  void tellHealth();

  std::string path_;
  std::uint64_t file_ = 0;  // inode of the socket's file
  Timestamp looked_{};      // whether it is still there
  const shm::DevicesSegment& segment_;
  const Clock& clock_;
  net::ConnectionServer server_;
  SpnavDevice device_;
  std::uint64_t seen_;  // samples of the ball
  bool there_ = false;
  SampleWaker waker_;
  net::ServerThread thread_;
};

}  // namespace merlin::serve
