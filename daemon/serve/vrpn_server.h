// VrpnServer: hand, tracker and ball for programs that read VRPN, on the loopback device.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/serve/vrpn_protocol.h"
#include "daemon/shm/layout.h"

namespace merlin::serve {

// Devices: Hand0 (tracker, sensor 0, smoothed; analog, 23 joints in radians), Tracker0 (tracker,
// sensors 0 to 3), Ball0 (analog, 6 shares of full scale; buttons). Positions in metres, in the
// transmitter's frame. Over TCP, asked for by TCP or by UDP. Owns its thread; reads the segment as
// any client does.
class VrpnServer {
 public:
  // `port` 0 takes any free one. Errors: kBusy (the port is taken), kIo. `segment` outlives this.
  static Result<std::unique_ptr<VrpnServer>> start(int port, const shm::DevicesSegment& segment,
                                                   const Clock& clock);
  ~VrpnServer();
  VrpnServer(const VrpnServer&) = delete;
  VrpnServer& operator=(const VrpnServer&) = delete;

  int port() const noexcept { return port_; }

 private:
  struct Client {
    UniqueFd fd;
    std::string input, output;
    bool greeted = false;                                // its cookie has come
    std::map<std::int32_t, std::string> senders, types;  // its numbers for names
    std::uint32_t sequence = 0;
    std::uint32_t buttons = 0;
  };
  VrpnServer(UniqueFd tcp, UniqueFd udp, int port, const shm::DevicesSegment& segment,
             const Clock& clock);
  void run(const std::stop_token& stop);
  void acceptClients();
  void answerDatagrams();
  void greet(UniqueFd fd);
  bool serve(Client& client);  // false once it is gone
  void handle(Client& client, const VrpnMessage& message);
  void send(Client& client, std::int32_t sender, std::int32_t type, std::string payload,
            std::int64_t at_ns);
  void tellSamples();
  template <typename T>
  void each(const shm::Channel<T>& channel, std::uint64_t& seen,
            const std::function<void(Client&, const T&)>& tell);

  UniqueFd tcp_, udp_;
  int port_;
  const shm::DevicesSegment& segment_;
  const Clock& clock_;
  std::vector<Client> clients_;
  std::uint64_t seen_hand_, seen_ball_;
  std::array<std::uint64_t, kStations> seen_tracker_{};
  std::jthread thread_;
};

}  // namespace merlin::serve
