// SpnavServer: offers MERLIN's balls as one space mouse, on the socket that libspnav opens.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/net/server_thread.h"
#include "daemon/serve/sample_waker.h"
#include "daemon/serve/spnav_protocol.h"
#include "daemon/shm/device_slots.h"

namespace merlin::serve {

// Owns its threads; reads shared memory as any client does, so that a slow program delays nobody.
//
// libspnav takes the first message after a request as its answer. So after it has connected or sent
// a request, a client gets no events until it has sent nothing for 60 ms (at most 0.5 s if it keeps
// asking); then it gets the button events of that time and the newest motion.
//
// If there are several balls, clients are told of the first that works as the device, and get the
// events of all, as spacenavd merges several space mice.
class SpnavServer final : public net::Server {
 public:
  // Errors: those of listenLocal(). The segment of `devices`, `watch` and `clock` must
  // outlive the server.
  static Result<std::unique_ptr<SpnavServer>> start(const std::string& socket_path,
                                                    const shm::DeviceSlots& devices,
                                                    ThreadWatch& watch, const Clock& clock);
  ~SpnavServer() override;  // removes the socket
  SpnavServer(const SpnavServer&) = delete;
  SpnavServer& operator=(const SpnavServer&) = delete;

  net::ServerReport report() const override { return server_.report(); }
  std::string failure() const override { return thread_.failure(); }

 private:
  SpnavServer(std::string path, UniqueFd listener, const shm::DeviceSlots& devices,
              ThreadWatch& watch, const Clock& clock);
  void round();
  void listen(UniqueFd listener);
  void listenAgainWhereGone();
  void sendSamples();
  void sendMissed();
  void updateHealth();

  std::string path_;
  std::uint64_t file_ = 0;  // inode of the socket's file
  Timestamp checked_{};     // when the file was last checked
  shm::DeviceSlots devices_;
  const Clock& clock_;
  net::ConnectionServer server_;
  SpnavDevice device_;
  struct Ball {
    shm::DeviceSlots::Ball slots;
    std::uint64_t seen = 0;  // number of samples processed
  };
  std::vector<Ball> balls_;
  const shm::Channel<BallSample>* last_ = nullptr;  // samples of the ball that sent last
  bool there_ = false;
  SampleWaker waker_;
  net::ServerThread thread_;
};

}  // namespace merlin::serve
