// ProjectorLoop: connects to one projector and sends it queries and commands; run() is the body of
// its thread. A connection is closed when nothing is left to send: some projectors serve only one
// client at a time, and some close the connection after each answer.
#pragma once

#include <functional>
#include <mutex>
#include <stop_token>

#include "daemon/base/clock.h"
#include "drivers/pjlink/projector.h"
#include "drivers/port/byte_stream.h"

namespace merlin::pjlink {

class ProjectorLoop {
 public:
  // `open` connects to the projector; it may block for seconds. `answer_time`: time within which
  // the greeting, or the whole answer to a command, must arrive. `clock` must outlive this object.
  ProjectorLoop(const PjlinkSettings& settings, StreamOpener open, Clock& clock,
                Duration answer_time = std::chrono::seconds(5));

  // Runs until `stop`. `alive` is called several times a second, except while `open` blocks.
  void run(
      const std::stop_token& stop, const std::function<void()>& alive = [] {});
  // Makes one connection, if a command is due. Called by run(), and by tests without a thread.
  void round(
      const std::stop_token& stop = {}, const std::function<void()>& alive = [] {});

  // The same as Projector::want() and Projector::state(), but thread-safe. After want(), the
  // projector is contacted within 100 ms, unless a connection is already in progress.
  void want(bool on);
  ProjectorState state() const;

 private:
  struct Waiting {
    const std::stop_token& stop;
    const std::function<void()>& alive;
  };
  Result<Ok> talk(const Waiting& waiting);
  Result<Answer> ask(ByteStream& stream, Session& session, Command command, const Waiting& waiting);
  Result<Ok> awaitGreeting(ByteStream& stream, Session& session, const Waiting& waiting);
  Result<std::optional<Answer>> receive(ByteStream& stream, Session& session, Timestamp deadline,
                                        const Waiting& waiting);
  std::optional<Command> next() const;

  const PjlinkSettings settings_;
  StreamOpener open_;
  Clock& clock_;
  Duration answer_time_;
  mutable std::mutex mutex_;  // guards projector_; never held while anything is waited for
  Projector projector_;
};

}  // namespace merlin::pjlink
