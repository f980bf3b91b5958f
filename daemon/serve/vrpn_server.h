// VrpnServer: hand, tracker and ball for programs that read VRPN, on the loopback device.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/token_bucket.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/net/server_thread.h"
#include "daemon/serve/sample_waker.h"
#include "daemon/serve/vrpn_protocol.h"
#include "daemon/shm/device_slots.h"

namespace merlin::serve {

class VrpnSession;

// Devices: Hand0 (tracker: sensor 0, smoothed; analog: 23 joint angles in radians), Tracker0
// (tracker, sensors 0 to 3), Ball0 (analog, 6 shares of full scale; buttons), and likewise Hand1
// and so on where there are several, in the order of the configuration. Positions are in metres, in
// the frame of each station. Data are sent over TCP; a client connects by TCP, or asks
// by UDP to be connected to. Owns its threads; reads shared memory as any client does.
class VrpnServer final : public net::Server {
 public:
  // `port` 0 takes any free one. `instance`: that of the daemon, which the server sends to its
  // clients (kVrpnInstance). Errors: those of listenTcp(). `devices`, `watch` and `clock` must
  // outlive the server.
  static Result<std::unique_ptr<VrpnServer>> start(int port, const shm::DeviceSlots& devices,
                                                   ThreadWatch& watch, const Clock& clock,
                                                   std::string instance = "merlin");
  ~VrpnServer() override;
  VrpnServer(const VrpnServer&) = delete;
  VrpnServer& operator=(const VrpnServer&) = delete;

  int port() const noexcept { return port_; }
  net::ServerReport report() const override { return server_.report(); }
  std::string failure() const override { return thread_.failure(); }

 private:
  struct Sockets {
    UniqueFd tcp, udp;
  };
  VrpnServer(Sockets sockets, const shm::DeviceSlots& devices, ThreadWatch& watch,
             const Clock& clock, std::string instance);
  void round();
  void answerDatagrams();
  void connectBack(int port);
  void sendSamples();
  template <typename T>
  void each(const shm::Channel<T>& channel, std::uint64_t& seen,
            const std::function<void(VrpnSession&, const T&, std::string&)>& send);

  UniqueFd udp_;
  int port_;
  shm::DeviceSlots devices_;
  const Clock& clock_;
  std::string instance_;
  std::set<int> connected_back_;  // clients' ports that we are connected to; must outlive server_
  net::ConnectionServer server_;
  TokenBucket datagrams_;
  // Number of samples processed, by the index of DeviceSlots.
  std::vector<std::uint64_t> seen_hands_, seen_balls_;
  std::vector<std::array<std::uint64_t, kStations>> seen_trackers_;
  SampleWaker waker_;
  net::ServerThread thread_;
};

}  // namespace merlin::serve
