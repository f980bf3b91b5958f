// SampleLink: another machine's devices in this machine's shared memory. The wall, and every other
// client, then reads them as if the serial ports were here.
#pragma once

#include <memory>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/shm/layout.h"
#include "daemon/status/curve.h"

namespace merlin::status {

struct SampleLinkSettings {
  std::string endpoint;                               // "tcp://HOST:PORT" of the other daemon
  std::string server_key;                             // its public key
  KeyPair keys;                                       // ours
  Duration silence = std::chrono::milliseconds(500);  // after which the link counts as gone
  // After so much silence the socket is made anew, then each time after twice as long, up to the
  // second figure: libzmq never connects again by itself where the peer once broke the protocol (it
  // did not know our key, or another program answered on its port).
  Duration renew_after = std::chrono::seconds(2), renew_at_most = std::chrono::seconds(5);
};

// Follows the topic "sample" on a thread of its own and writes what it says into `segment`, whose
// only writer it is. Times become this machine's, as old as they were there when they were sent:
// the network's own delay is not known and not added. While no word comes, every device is absent,
// with the reason.
class SampleLink {
 public:
  // Errors: kInvalidArgument (an endpoint or a key that is none).
  static Result<std::unique_ptr<SampleLink>> start(SampleLinkSettings settings,
                                                   shm::DevicesSegment& segment, ThreadWatch& watch,
                                                   const Clock& clock);
  ~SampleLink();
  SampleLink(const SampleLink&) = delete;
  SampleLink& operator=(const SampleLink&) = delete;

 private:
  struct Socket;
  SampleLink(SampleLinkSettings settings, shm::DevicesSegment& segment, const Clock& clock);
  void connect();  // throws what libzmq throws
  void run(const std::stop_token& stop, Progress& progress);
  bool take();  // one document, where one has come
  void renewWhereSilent(Timestamp now);
  void lost(Timestamp now);

  SampleLinkSettings settings_;
  std::unique_ptr<Socket> socket_;
  shm::DevicesSegment& segment_;
  const Clock& clock_;
  Timestamp heard_{};
  Timestamp connected_{};
  Duration renew_after_;
  bool ever_ = false;
  std::string said_;  // what went wrong last
  WatchedThread thread_;
};

// The document's content into the segment; samples whose counter has not changed are left. False
// for a document that is none. For SampleLink and its tests.
bool applySamples(const std::string& document, const std::string& from, Timestamp now,
                  shm::DevicesSegment& segment);

}  // namespace merlin::status
