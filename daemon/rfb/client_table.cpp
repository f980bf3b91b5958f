#include "daemon/rfb/client_table.h"

#include <algorithm>
#include <csignal>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/base/log.h"
#include "daemon/cli/exit_status.h"
#include "daemon/rfb/client_process.h"

namespace merlin::rfb {
namespace {

constexpr Duration kIdle = std::chrono::minutes(1);
constexpr Duration kTellEvery = std::chrono::seconds(5);

std::string howItEnded(int status, bool established) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    return established ? "closed: a message took too long" : "the handshake took too long";
  if (WIFSIGNALED(status))
    return fmt::format("its process was ended by signal {}", WTERMSIG(status));
  if (WEXITSTATUS(status) == kWrongPassword) return "wrong password";
  if (WEXITSTATUS(status) != kClientLeft)
    return fmt::format("its process ended with status {}", WEXITSTATUS(status));
  return established ? "left" : "left before the handshake was complete";
}

void unblockSignals() {
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

}  // namespace

ClientTable::ClientTable(int places, Serve serve) : serve_(std::move(serve)) {
  places_.all = places_.per_peer = static_cast<std::size_t>(places);
  places_.idle = kIdle;
}

ClientTable::~ClientTable() {
  for (const Client& client : clients_) ::kill(client.pid, SIGKILL);
  for (const Client& client : clients_) waitForChild(client.pid);
}

void ClientTable::add(UniqueFd client, Timestamp now) {
  const net::Peer peer = net::peerOf(client.get());
  std::vector<net::Occupant> occupants;
  for (const Client& c : clients_) occupants.push_back(c.occupant);
  const net::Decision decision = net::decide(occupants, peer, places_, now);
  switch (decision.kind) {
    case net::Decision::Kind::kRefuse:
      logSentAway(peer, fmt::format("all {} places are taken (--clients)", places_.all), now);
      return;
    case net::Decision::Kind::kReplace:
      end(decision.victim, "closed: another client needed the place", now);
      break;
    case net::Decision::Kind::kAdmit: break;
  }
  start(std::move(client), peer, now);
}

void ClientTable::start(UniqueFd client, const net::Peer& peer, Timestamp now) {
  auto report = makePipe();
  if (!report) return logSentAway(peer, report.error().what, now);
  const pid_t parent = ::getpid();
  const auto child = startChild();
  if (!child) return logSentAway(peer, child.error().what, now);
  if (*child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(kExitFailed);  // the parent ended before prctl()
    clients_.clear();                                 // closes the other clients' pipes
    report->from.reset();
    unblockSignals();
    ::_exit(runGuarded("merlin-rfb", [&] { return serve_(client.get(), report->to.get()); }));
  }
  clients_.push_back({*child, std::move(report->from), {peer, now, now, false}});
}

void ClientTable::appendTo(std::vector<pollfd>& set) const {
  for (const Client& client : clients_) set.push_back({client.report.get(), POLLIN, 0});
}

void ClientTable::read(int fd, Timestamp now) {
  const auto found = std::find_if(clients_.begin(), clients_.end(),
                                  [&](const Client& c) { return c.report.get() == fd; });
  if (found == clients_.end()) return;  // ended a moment ago
  char bytes[64];
  const ssize_t count = ::read(fd, bytes, sizeof bytes);
  if (count <= 0) {
    remove(static_cast<std::size_t>(found - clients_.begin()), now);
    return;
  }
  found->occupant.active = now;
  const bool established =
      std::find(bytes, bytes + count, static_cast<char>(Report::kEstablished)) != bytes + count;
  if (!established || found->occupant.established) return;
  found->occupant.established = true;
  logInfo("{}: connected, {} of {} places are taken", net::peerName(found->occupant.peer),
          clients_.size(), places_.all);
}

void ClientTable::end(std::size_t index, const std::string& reason, Timestamp now) {
  Client& client = clients_[index];
  ::kill(client.pid, SIGKILL);
  waitForChild(client.pid);
  if (client.occupant.established)
    logInfo("{}: {}", net::peerName(client.occupant.peer), reason);
  else
    logSentAway(client.occupant.peer, reason, now);
  clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(index));
}

// Removes a client whose process has closed its end of the pipe, which means that it ends or has
// ended.
void ClientTable::remove(std::size_t index, Timestamp now) {
  const Client& client = clients_[index];
  const std::string how = howItEnded(waitForChild(client.pid), client.occupant.established);
  if (client.occupant.established)
    logInfo("{}: {}", net::peerName(client.occupant.peer), how);
  else
    logSentAway(client.occupant.peer, how, now);
  clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(index));
}

void ClientTable::logSentAway(const net::Peer& peer, const std::string& why, Timestamp now) {
  ++sent_away_;
  if (now - logged_ < kTellEvery) return;
  logged_ = now;
  logWarning(
      "{}: {}{}", net::peerName(peer), why,
      sent_away_ > 1 ? fmt::format(" ({} connections since the last such line)", sent_away_) : "");
  sent_away_ = 0;
}

}  // namespace merlin::rfb
