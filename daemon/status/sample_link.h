// SampleLink: copies the samples of another machine's devices into this machine's shared memory,
// where the wall and every other client read them like those of local devices.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/fields.h"
#include "daemon/shm/layout.h"
#include "daemon/status/curve.h"

namespace merlin::status {

struct SampleLinkSettings {
  std::string endpoint;                               // "tcp://HOST:PORT" of the other daemon
  std::string server_key;                             // public key of the other daemon
  KeyPair keys;                                       // this machine's keys
  Duration silence = std::chrono::milliseconds(500);  // after which the link counts as lost
  // The socket is recreated after renew_after of silence, then each time after twice as long, up to
  // renew_at_most: libzmq does not reconnect by itself after a protocol error (the peer did not
  // know our key, or another program answered on its port).
  Duration renew_after = std::chrono::seconds(2), renew_at_most = std::chrono::seconds(5);
};

// Follows the topic "sample" on a thread of its own and writes the samples of the devices and hands
// in `names` into `segment`, whose only writer it is; all others are ignored. Converts times to
// this machine's clock so that a sample has the age that it had when it was sent; the delay of the
// network is unknown and not added. While nothing is received, the health of every device is
// absent, with the reason.
class SampleLink {
 public:
  // Errors: kInvalidArgument (an invalid endpoint or key).
  static Result<std::unique_ptr<SampleLink>> start(SampleLinkSettings settings,
                                                   shm::SlotNames names,
                                                   shm::DevicesSegment& segment, ThreadWatch& watch,
                                                   const Clock& clock);
  ~SampleLink();
  SampleLink(const SampleLink&) = delete;
  SampleLink& operator=(const SampleLink&) = delete;

 private:
  struct Socket;
  SampleLink(SampleLinkSettings settings, shm::SlotNames names, shm::DevicesSegment& segment,
             const Clock& clock);
  void connect();  // throws zmq::error_t
  void run(const std::stop_token& stop, Progress& progress);
  bool take();  // receives a document, if there is one, and applies it
  void renewWhereSilent(Timestamp now);
  void lost(Timestamp now);

  SampleLinkSettings settings_;
  shm::SlotNames names_;
  std::unique_ptr<Socket> socket_;
  shm::DevicesSegment& segment_;
  const Clock& clock_;
  Timestamp heard_{};
  Timestamp connected_{};
  Duration renew_after_;
  bool ever_ = false;
  std::string said_;  // the last error that was logged
  WatchedThread thread_;
};

// Publishes the samples of a document of the topic "sample" in `segment`, except those whose
// counter has not changed, and the health of the devices, with `from` as their port. Returns false
// if the document is invalid or has more than 64 KiB. For SampleLink and its tests.
bool applySamples(const std::string& document, const std::string& from, Timestamp now,
                  const shm::SlotNames& names, shm::DevicesSegment& segment);

}  // namespace merlin::status
