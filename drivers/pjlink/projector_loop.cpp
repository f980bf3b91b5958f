#include "drivers/pjlink/projector_loop.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "drivers/pjlink/password.h"

namespace merlin::pjlink {
namespace {

// Time between checks of `stop` and want().
constexpr Duration kSlice = std::chrono::milliseconds(100);
constexpr int kMostCommands = 16;  // greatest number in one connection

// kIo is included because a peer that closes a connection with unread bytes resets it.
bool isClosed(const Error& error) { return error.code == Errc::kClosed || error.code == Errc::kIo; }

}  // namespace

ProjectorLoop::ProjectorLoop(const PjlinkSettings& settings, StreamOpener open, Clock& clock,
                             Duration answer_time)
    : settings_(settings),
      open_(std::move(open)),
      clock_(clock),
      answer_time_(answer_time),
      projector_(settings, clock.now()) {}

void ProjectorLoop::run(const std::stop_token& stop, const std::function<void()>& alive) {
  while (!stop.stop_requested()) {
    alive();
    round(stop, alive);
    if (!clock_.sleepUntil(clock_.now() + kSlice, stop)) break;
  }
}

void ProjectorLoop::round(const std::stop_token& stop, const std::function<void()>& alive) {
  if (!next()) return;
  const auto talked = talk({stop, alive});
  if (talked || stop.stop_requested()) return;
  const std::lock_guard lock(mutex_);
  projector_.lost(talked.error(), clock_.now());
}

std::optional<Command> ProjectorLoop::next() const {
  const std::lock_guard lock(mutex_);
  return projector_.next(clock_.now());
}

void ProjectorLoop::want(bool on) {
  const std::lock_guard lock(mutex_);
  projector_.want(on, clock_.now());
}

ProjectorState ProjectorLoop::state() const {
  const std::lock_guard lock(mutex_);
  return projector_.state(clock_.now());
}

// Reads the password for each connection, so that a corrected file takes effect.
Result<Ok> ProjectorLoop::talk(const Waiting& waiting) {
  auto password = readPassword(settings_.password_file);
  if (!password) return Error{Errc::kInvalidArgument, password.error().what};
  const auto stream = open_();
  if (!stream) return Error{Errc::kIo, stream.error().what};
  Session session(*std::move(password));
  if (const auto greeted = awaitGreeting(**stream, session, waiting); !greeted)
    return greeted.error();
  for (int sent = 0; sent < kMostCommands; ++sent) {
    const auto command = next();
    if (!command) break;
    const auto answer = ask(**stream, session, *command, waiting);
    // If the projector closes the connection after each answer, the next connection sends the rest.
    const bool between = sent > 0 && session.isAtLineStart();
    if (!answer && between && isClosed(answer.error())) break;
    if (!answer) return answer.error();
    const std::lock_guard lock(mutex_);
    projector_.answered(*command, *answer, clock_.now());
  }
  return Ok{};
}

Result<Ok> ProjectorLoop::awaitGreeting(ByteStream& stream, Session& session,
                                        const Waiting& waiting) {
  const Timestamp deadline = clock_.now() + answer_time_;
  while (!session.isOpen()) {
    if (const auto got = receive(stream, session, deadline, waiting); !got) return got.error();
  }
  return Ok{};
}

Result<Answer> ProjectorLoop::ask(ByteStream& stream, Session& session, Command command,
                                  const Waiting& waiting) {
  const std::string bytes = session.request(command, settings_.input);
  const Timestamp deadline = clock_.now() + answer_time_;
  const auto written = stream.write(std::as_bytes(std::span(bytes)), answer_time_);
  if (!written) return written.error();
  for (;;) {
    auto got = receive(stream, session, deadline, waiting);
    if (!got) return got.error();
    if (*got) return **std::move(got);
  }
}

// Reads the bytes that arrive within one kSlice; returns the answer that they complete, or nothing.
// Errors: kTimeout (the deadline has passed), those of the stream and of Session::feed().
Result<std::optional<Answer>> ProjectorLoop::receive(ByteStream& stream, Session& session,
                                                     Timestamp deadline, const Waiting& waiting) {
  waiting.alive();
  if (waiting.stop.stop_requested()) return Error{Errc::kClosed, "stopped"};
  const Duration left = deadline - clock_.now();
  if (left <= Duration::zero()) {
    return Error{Errc::kTimeout,
                 fmt::format("does not answer within {:g} s", toSeconds(answer_time_))};
  }
  std::array<std::byte, 256> buffer{};
  const auto n = stream.read(buffer, std::min(left, kSlice));
  if (!n && n.error().code == Errc::kTimeout) return std::optional<Answer>();
  if (!n) return Error{n.error().code, fmt::format("closes the connection ({})", n.error().what)};
  return session.feed({reinterpret_cast<const char*>(buffer.data()), *n});
}

}  // namespace merlin::pjlink
