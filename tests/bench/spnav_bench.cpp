// ./dev bench spnav: time from the last byte of a ball's record on its line to a client of the
// space-mouse socket, for merlind and for spacenavd on the same emulated Spaceball, in turns. Both
// are compared with a bare loop, which reads the line and writes to the client: the minimum for one
// process between line and client.
//
// The client implements the socket's protocol itself, so that one process can have several
// connections; libspnav would add the same time to all three subjects.
#include <array>
#include <atomic>
#include <filesystem>
#include <map>
#include <optional>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drivers/io/pty_master.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/latency_kind.h"
#include "tests/bench/latency_line.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

struct Options {
  std::string bin;
  std::uint32_t samples = 1000;
  int rounds = 4;
  double rate_hz = 100;
};

enum Server { kMerlind, kSpacenavd, kBare };
constexpr const char* kNames[] = {"merlind", "spacenavd", "bare loop"};

std::int64_t now() { return toNanoseconds(SystemClock().now()); }

// An event of version 0 of the protocol: type, six axes or a button, time [ms].
using Event = std::array<std::int32_t, 8>;

// Connects to a server's socket as soon as it exists.
UniqueFd connectTo(const std::string& path, const std::function<bool()>& ended) {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  const bool connected = test::eventually([&] {
    return ended() ||
           ::connect(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  });
  if (!connected || ended()) fd.reset();
  return fd;
}

// A client of the socket, with its own thread; stores the time of each motion and its first axis.
class Client {
 public:
  explicit Client(UniqueFd socket) : socket_(std::move(socket)) {
    thread_ = std::thread([this] {
      askForRealTime();
      Event event{};
      while (::recv(socket_.get(), event.data(), sizeof event, MSG_WAITALL) == sizeof event) {
        const std::uint32_t place = count_;
        if (event[0] != 0 || place >= kMost) continue;
        motions_[place] = {now(), event[1]};
        count_ = place + 1;
      }
    });
  }
  ~Client() {
    ::shutdown(socket_.get(), SHUT_RDWR);
    thread_.join();
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  struct Motion {
    std::int64_t at_ns;
    std::int32_t x;
  };
  std::uint32_t count() const noexcept { return count_; }
  const Motion& motion(std::uint32_t n) const noexcept { return motions_[n]; }

 private:
  static constexpr std::uint32_t kMost = 1 << 17;
  UniqueFd socket_;
  std::vector<Motion> motions_{kMost};
  std::atomic<std::uint32_t> count_{0};
  std::thread thread_;
};

// The bare loop, in its own process: it counts whole records and sends a motion with the first axis
// of each record.
class BareServer {
 public:
  BareServer(const std::string& line, const std::string& path) {
    listener_.reset(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    if (::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener_.get(), 1) != 0)
      didNotRun(path, "it cannot be listened at", "see /tmp");
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    serve(line);
    ::_exit(0);
  }
  ~BareServer() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  BareServer(const BareServer&) = delete;
  BareServer& operator=(const BareServer&) = delete;

 private:
  void serve(const std::string& line) const {
    askForRealTime();
    const UniqueFd port(::open(line.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    const UniqueFd client(::accept(listener_.get(), nullptr, nullptr));
    const std::size_t length = kBallKind.record(0).size();
    std::string bytes;
    char buffer[256];
    for (pollfd item{port.get(), POLLIN, 0}; ::poll(&item, 1, -1) >= 0;) {
      const ssize_t n = ::read(port.get(), buffer, sizeof buffer);
      if (n > 0) bytes.append(buffer, static_cast<std::size_t>(n));
      for (; bytes.size() >= length; bytes.erase(0, length)) {
        const Event event{0, static_cast<unsigned char>(bytes[4])};
        if (::send(client.get(), event.data(), sizeof event, MSG_NOSIGNAL) < 0) return;
      }
    }
  }

  UniqueFd listener_;
  pid_t pid_ = -1;
};

io::PtyMaster openLine() {
  auto line = io::PtyMaster::open("");
  if (!line) didNotRun("a pseudo-terminal", line.error().what, "see /dev/pts");
  return *std::move(line);
}

// A server that reads a line of its own.
class Subject {
 public:
  Subject(Server server, const Options& options, const test::TempDir& dir)
      : server_(server), line_(openLine()) {
    const std::string folder = dir / kNames[server];
    std::filesystem::create_directories(folder + "/run");
    socket_ = folder + "/run/spnav.sock";
    if (server == kBare) {
      bare_.emplace(line_.slavePath(), socket_);
    } else if (server == kSpacenavd) {
      test::writeText(folder + "/rc", "serial = " + line_.slavePath() + "\nled = off\n");
      // Debian's spacenavd binds run/spnav.sock relative to its working directory (/ as a service).
      process_.emplace(
          std::vector<std::string>{"sh", "-c", "cd '" + folder + "' && exec spacenavd -d -c rc"});
    } else {
      startMerlind(options, folder);
    }
  }

  // Measures the time from a record's last byte to the client [us], for each of `samples` records.
  std::vector<double> measure(const Options& options);

 private:
  void startMerlind(const Options& options, const std::string& folder) {
    const nlohmann::json config = {
        {"instance", test::privateName("spnav")},
        {"run_directory", folder},
        {"postures", {{"file", ""}}},
        {"devices",
         nlohmann::json::array(
             {{{"name", "ball"}, {"driver", "spaceball"}, {"port", "pty:" + line_.slavePath()}}})},
        {"hands", nlohmann::json::array()},
        {"bindings", nlohmann::json::array()},
        {"serve", {{"spnav_socket", socket_}}}};
    test::writeText(folder + "/merlin.json", config.dump());
    process_.emplace(std::vector<std::string>{options.bin + "/merlind", "--config",
                                              folder + "/merlin.json", "--role", "devices"});
  }

  [[noreturn]] void fail(const std::string& found) {
    didNotRun(kNames[server_], found + (process_ ? ": " + process_->output() : ""),
              "apt-get install spacenavd; --bin names merlind's folder");
  }

  void send(std::uint32_t n) const {
    const std::string bytes = kBallKind.record(n);
    (void)!::write(line_.fd(), bytes.data(), bytes.size());
  }

  std::vector<double> exchange(const Options& options, Client& client) {
    const std::uint32_t first = client.count();
    std::vector<std::int64_t> sent_ns(options.samples);
    std::thread device([&] {
      askForRealTime();  // this thread takes the place of the hardware, so nothing may delay it
      atIrregularTimes(options.samples, options.rate_hz, [&](std::uint32_t n) {
        sent_ns[n] = now();
        send(n);
      });
    });
    device.join();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const std::uint32_t told = client.count() - first;
    if (told != options.samples)
      fail(fmt::format("of {} records it told {}", options.samples, told));
    std::vector<double> all_us;
    for (std::uint32_t n = 0; n < told; ++n)
      all_us.push_back(1e-3 * static_cast<double>(client.motion(first + n).at_ns - sent_ns[n]));
    return all_us;
  }

  Server server_;
  io::PtyMaster line_;
  std::string socket_;
  std::optional<test::Process> process_;
  std::optional<BareServer> bare_;
};

std::vector<double> Subject::measure(const Options& options) {
  std::atomic<bool> streams{server_ == kBare};
  // The emulator has to answer from the start: spacenavd gives up on a ball that does not answer,
  // and then makes no socket.
  std::thread ball([&] {
    const auto emulator = emulate::findEmulator("spaceball")
                              ->make({}, *emulate::findMotionScript("still"), SystemClock().now());
    serveDialogue(line_.fd(), *emulator, [&] { return streams.load(); });
  });
  UniqueFd socket = connectTo(socket_, [&] { return process_ && process_->ended(); });
  std::optional<Client> client;
  if (socket.valid()) client.emplace(std::move(socket));
  // The records differ, since spacenavd reports changes only.
  for (std::uint32_t n = 0; client && !streams && n < 1500; ++n) {
    send(n);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    streams = client->count() > 3;
  }
  const bool told = streams.exchange(true);
  ball.join();
  if (!told) fail("it told nothing of the emulated ball");
  // After this time, everything that was on its way has arrived.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  return exchange(options, *client);
}

bool bench(const Options& options, Report& report) {
  std::map<Server, std::vector<double>> all;
  for (int round = 0; round < options.rounds; ++round) {
    for (const Server server : {kMerlind, kSpacenavd, kBare}) {
      note(fmt::format("{}: round {} of {}", kNames[server], round + 1, options.rounds));
      const test::TempDir dir;
      const std::vector<double> us = Subject(server, options, dir).measure(options);
      all[server].insert(all[server].end(), us.begin(), us.end());
    }
  }
  report.text("from a ball's byte to a client of the space-mouse socket, microseconds\n");
  report.text("server          n    median       p99     p99.9\n");
  for (const auto& [server, us] : all) {
    const std::string what = fmt::format("records told by {}", kNames[server]);
    const auto median = medianOf(us, what), p99 = quantileOf(us, 0.99, what);
    report.text("{:10} {:6} {:9.1f} {:9.1f} {:9.1f}\n", kNames[server], us.size(), median.value(),
                p99.value(), quantileOf(us, 0.999, what).value());
    report.figure(fmt::format("{}.median", kNames[server]), median, "us");
    report.figure(fmt::format("{}.p99", kNames[server]), p99, "us");
  }
  const auto ratio =
      ratioOf(medianOf(all[kMerlind], "records"), medianOf(all[kSpacenavd], "records"), "records");
  report.text("merlind by spacenavd, medians: {:.2f} (limit 1): {}\n", ratio.value(),
              ratio <= 1 ? "yes" : "NO");
  report.figure("merlind_by_spacenavd", ratio, "1");
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::Options options;
  merlin::bench::CommandLine app(
      "Latency from a ball's byte to a client of the space-mouse socket.");
  app.option("--bin", options.bin, "Folder of merlind").required();
  app.option("--samples", options.samples, "Number of records in a round")
      .range(10, 60'000)
      .showDefault();
  app.option("--rounds", options.rounds, "Number of rounds").range(1, 1000).showDefault();
  return app.run("spnav", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::bench(options, report);
  });
}
