// Runs the installed programs, with the installed configuration and the restrictions of the
// installed units, but without systemd.
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/unique_fd.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr unsigned kNobody = 65534;  // the user to which under_unit changes from root

// A socket that is bound to a free port of the loopback interface.
struct LocalSocket {
  UniqueFd fd{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  int port = 0;  // 0: there is no free port

  LocalSocket() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const raw = reinterpret_cast<sockaddr*>(&address);
    if (::bind(fd.get(), raw, sizeof address) != 0 || ::getsockname(fd.get(), raw, &size) != 0)
      return;
    port = ntohs(address.sin_port);
  }
};

int freePort() { return LocalSocket().port; }

// Connects to the port; the result is invalid if nothing listens there.
UniqueFd connected(int port) {
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  return fd;
}
bool connects(int port) { return connected(port).valid(); }

class Install : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::chmod(dir_.path().c_str(), 0755), 0);
    const Outcome done = install();
    ASSERT_EQ(done.status, 0) << done.output;
  }

  Outcome install(const std::string& component = "merlin") {
    return run({"env", "DESTDIR=" + root_, "cmake", "--install", MERLIN_BINARY_DIR, "--prefix",
                "/usr", "--component", component});
  }

  // A run directory to which the service's user may write.
  std::string runDirectory() {
    const std::string path = dir_ / "run";
    fs::create_directories(path);
    if (::geteuid() == 0) {
      EXPECT_EQ(::chown(path.c_str(), kNobody, kNobody), 0);
    }
    return path;
  }

  // Writes the installed configuration, changed to show a model and to use names private to this
  // test, with `patch` merged into it; returns its path.
  std::string configuration(const json& patch) {
    const std::string model = makeModel(dir_, 5);
    json config = json::parse(readText(root_ + "/etc/merlin/merlin.json"));
    config.merge_patch({{"instance", instance_},
                        {"run_directory", runDirectory()},
                        {"wall", {{"model", model}, {"rate", {{"rate_hz", 10}}}}}});
    config.merge_patch(patch);
    const std::string path = root_ + "/etc/merlin/test.json";
    writeText(path, config.dump());
    EXPECT_EQ(::chmod(path.c_str(), 0644), 0);
    return path;
  }

  std::vector<std::string> underUnit(std::vector<std::string> program, const std::string& unit,
                                     const std::vector<std::string>& drop_ins = {}) {
    std::vector<std::string> arguments = {MERLIN_BIN_DIR "/under_unit",
                                          root_ + "/usr/lib/systemd/system/" + unit};
    for (const std::string& name : drop_ins)
      arguments.push_back(root_ + "/usr/share/merlin/" + unit + ".d/" + name);
    arguments.emplace_back("--");
    arguments.insert(arguments.end(), program.begin(), program.end());
    return arguments;
  }

  // Starts the process of a role under its unit's restrictions, with the unit's command line except
  // for the configuration.
  std::unique_ptr<Process> start(const std::string& role, const std::string& configuration,
                                 const std::vector<std::string>& drop_ins = {}) {
    auto process = std::make_unique<Process>(
        underUnit({merlind_, "--role", role, "--last-good", "--config", configuration},
                  "merlin-" + role + ".service", drop_ins),
        std::map<std::string, std::string>{{"STATE_DIRECTORY", runDirectory()}});
    EXPECT_TRUE(process->saysEventually("ready")) << process->output();
    return process;
  }

  Outcome merlin(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), root_ + "/usr/bin/merlin");
    arguments.insert(arguments.end(), {"--instance", instance_});
    return run(arguments);
  }

  TempDir dir_;
  std::string root_ = dir_ / "root";
  std::string merlind_ = root_ + "/usr/bin/merlind";
  std::string instance_ = privateName("installed");
};

TEST_F(Install, LeavesEverythingThatTheServiceNeedsAndKeepsAConfiguration) {
  for (const char* path : {"/usr/bin/merlind",
                           "/usr/bin/merlin",
                           "/usr/lib/systemd/system/merlin-devices.service",
                           "/usr/lib/systemd/system/merlin-wall.service",
                           "/usr/lib/sysusers.d/merlin.conf",
                           "/usr/lib/systemd/system/merlin-page.service",
                           "/usr/lib/sysusers.d/merlin-page.conf",
                           "/usr/lib/systemd/system/merlin-alarms.service",
                           "/usr/lib/sysusers.d/merlin-alarms.conf",
                           "/usr/lib/systemd/system/merlin.target",
                           "/usr/lib/systemd/system/merlin.slice",
                           "/usr/lib/systemd/system/merlin-wall.service.d/displays.conf",
                           "/usr/lib/tmpfiles.d/merlin.conf",
                           "/usr/lib/udev/rules.d/60-merlin.rules",
                           "/usr/share/man/man1/merlin.1.gz",
                           "/usr/share/man/man8/merlind.8.gz",
                           "/usr/share/man/man5/merlin.json.5.gz",
                           "/usr/share/bash-completion/completions/merlin",
                           "/usr/share/merlin/ankylosaurus.mrm",
                           "/usr/share/merlin/wall.json",
                           "/usr/share/merlin/gestures.json",
                           "/usr/share/merlin/merlin-devices.service.d/network.conf",
                           "/usr/share/merlin/merlin-devices.service.d/gpio.conf",
                           "/usr/share/merlin/merlin-devices.service.d/input.conf",
                           "/usr/share/merlin/merlin-wall.service.d/gpu.conf",
                           "/usr/share/merlin/merlin-wall.service.d/files.conf",
                           "/usr/share/merlin/spnav.tmpfiles.conf",
                           "/usr/share/doc/merlin/LICENSE",
                           "/usr/share/doc/merlin/DejaVuSans.LICENSE",
                           "/usr/share/doc/merlin/systemd/README.md",
                           "/usr/share/doc/merlin/systemd/from-boxes-to-wall.md",
                           "/usr/share/doc/merlin/daemon/alarms/README.md",
                           "/usr/share/doc/merlin/daemon/shm/read_merlin.c",
                           "/usr/share/doc/merlin/daemon/shm/read_merlin.cpp",
                           "/usr/share/doc/merlin/daemon/shm/read_merlin.py",
                           "/usr/share/doc/merlin/daemon/shm/layout.h",
                           "/usr/share/doc/merlin/daemon/status/read_status.py",
                           "/usr/share/merlin/merlin-alarms.service.d/mail.conf",
                           "/etc/merlin/merlin.json",
                           "/etc/merlin/postures.json",
                           "/etc/merlin/gestures.json",
                           "/etc/merlin/merlin.schema.json"}) {
    EXPECT_TRUE(fs::is_regular_file(root_ + path)) << path;
  }
  // The units start the installed daemon with the installed configuration, which start() assumes.
  for (const std::string& role : {std::string("devices"), std::string("wall")}) {
    const std::string unit =
        readText(root_ + "/usr/lib/systemd/system/merlin-" + role + ".service");
    EXPECT_NE(unit.find("ExecStart=/usr/bin/merlind --role " + role +
                        " --last-good --config /etc/merlin/merlin.json\n"),
              std::string::npos);
  }
  writeText(root_ + "/etc/merlin/merlin.json", "{\"instance\": \"mine\"}");
  ASSERT_EQ(install().status, 0);
  EXPECT_EQ(readText(root_ + "/etc/merlin/merlin.json"), "{\"instance\": \"mine\"}");
}

// Compiles the C++ example as its first lines say, using only installed files.
TEST_F(Install, TheExampleInCppIsCompiledFromThePackage) {
  ASSERT_EQ(install().status, 0);
  const std::string documents = root_ + "/usr/share/doc/merlin";
  const Outcome compiled = run({"g++", "-std=c++20", "-fsyntax-only", "-I" + documents,
                                documents + "/daemon/shm/read_merlin.cpp"});
  EXPECT_EQ(compiled.status, 0) << compiled.output;
}

// Returns the text of the first group of `pattern` in each match.
std::set<std::string> namedIn(const std::string& text, const char* pattern) {
  const std::regex named(pattern);
  std::set<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it)
    names.insert((*it)[1].str());
  return names;
}

// Sources, tests and build results exist in the repository only, as README.md says.
bool isOfTheRepository(const std::string& name) {
  return name.starts_with("tests/") || name.starts_with("build/") || name == "CONTRIBUTING.md";
}

// A document names a file relative to its own folder, or to the top folder of all documents.
bool isFile(const std::string& name, const fs::path& folder, const fs::path& top) {
  return fs::is_regular_file(folder / name) || fs::is_regular_file(top / name);
}

TEST_F(Install, EveryLinkToAFileInAnInstalledDocumentResolves) {
  const fs::path top = root_ + "/usr/share/doc/merlin";
  int documents = 0, links = 0;
  for (const auto& entry : fs::recursive_directory_iterator(top)) {
    if (entry.path().extension() != ".md") continue;
    ++documents;
    const fs::path folder = entry.path().parent_path();
    const fs::path source = fs::path(kSource) / folder.lexically_relative(top);
    const std::string text = readText(entry.path());
    for (const std::string& name : namedIn(text, "`([A-Za-z0-9_./-]+\\.(md|json|py|c|png))[`: ]")) {
      // A name that is not a file of the repository belongs to another program, or to a file that
      // users make.
      if (isOfTheRepository(name) || !isFile(name, source, kSource)) continue;
      ++links;
      EXPECT_TRUE(isFile(name, folder, top)) << name << " in " << entry.path();
    }
    for (const std::string& name : namedIn(text, "\\]\\(([^)# ]+)\\)")) {
      if (name.find("://") != std::string::npos) continue;
      ++links;
      EXPECT_TRUE(isFile(name, folder, folder)) << name << " in " << entry.path();
    }
  }
  EXPECT_GE(documents, 90);
  EXPECT_GE(links, 150);
}

TEST_F(Install, EveryDocumentThatTheManualPagesNameIsInstalled) {
  std::string text;
  for (const char* const what : {"--print-manual", "--print-config-manual"})
    text += run({merlind_, what}).output;
  text += run({root_ + "/usr/bin/merlin", "--print-manual"}).output;
  const auto documents = namedIn(text, "([a-z_]+/[a-z_/]*README\\.md)");
  EXPECT_GE(documents.size(), 3u);
  for (const std::string& name : documents)
    EXPECT_TRUE(fs::is_regular_file(root_ + "/usr/share/doc/merlin/" + name)) << name;
}

// The guide lets its readers copy an example before they have models of their own.
TEST_F(Install, EveryExampleThatTheGuideNamesIsValidWhenItIsCopied) {
  const auto examples =
      namedIn(readText(root_ + "/usr/share/doc/merlin/systemd/from-boxes-to-wall.md"),
              "/usr/share/merlin/([a-z0-9-]+\\.json)");
  EXPECT_GE(examples.size(), 3u);
  for (const std::string& name : examples) {
    std::string text = readText(root_ + "/usr/share/merlin/" + name);
    text = std::regex_replace(text, std::regex("/usr/share"), root_ + "/usr/share");
    text = std::regex_replace(text, std::regex("/var/lib/merlin"), runDirectory());
    json config = json::parse(text);
    config.merge_patch({{"run_directory", runDirectory()}});
    const std::string path = root_ + "/etc/merlin/test.json";
    writeText(path, config.dump());
    const Outcome checked = run({merlind_, "--check-config", path});
    EXPECT_EQ(checked.status, 0) << name << ": " << checked.output;
  }
}

// On a machine without devices and displays, the installed configuration shows the demo's model and
// raises no alarm.
TEST_F(Install, TheInstalledConfigurationShowsTheInstalledModelWithoutAnAlarm) {
  json config = json::parse(readText(root_ + "/etc/merlin/merlin.json"));
  EXPECT_EQ(config["wall"]["model"], "/usr/share/merlin/ankylosaurus.mrm");
  EXPECT_FALSE(config.contains("devices"));
  config["wall"]["model"] = root_ + "/usr/share/merlin/ankylosaurus.mrm";
  config["wall"]["playlist"]["after_s"] = 0.1;
  config["wall"]["rate"]["rate_hz"] = 10;
  // The displays of the machine on which the test runs must not be used.
  config["wall"]["outputs"][1]["kms"]["card"] = "/dev/dri/none";
  config.merge_patch({{"instance", instance_},
                      {"run_directory", runDirectory()},
                      {"state_file", runDirectory() + "/state.json"}});
  const std::string path = root_ + "/etc/merlin/test.json";
  writeText(path, config.dump());
  const Outcome checked = run({merlind_, "--check-config", path});
  EXPECT_EQ(checked.status, 0) << checked.output;

  const auto devices = start("devices", path), wall = start("wall", path);
  json status;
  EXPECT_TRUE(eventually([&] {
    status = json::parse(merlin({"status", "--json"}).output, nullptr, false);
    return !status.is_discarded() && status.value("playlist", "") == "running";
  })) << status.dump();
  for (Process* const process : {devices.get(), wall.get()}) {
    EXPECT_EQ(process->output().find(" warning: "), std::string::npos) << process->output();
    EXPECT_EQ(process->output().find(" error: "), std::string::npos) << process->output();
    EXPECT_EQ(process->kill(SIGTERM), 0);
  }
}

TEST_F(Install, TheInstalledDaemonRunsUnderItsUnits) {
  const std::string path = configuration(json::object());
  const auto devices = start("devices", path), wall = start("wall", path);
  const Outcome status = merlin({"status", "--json"});
  ASSERT_EQ(status.status, 0) << status.output;
  EXPECT_GT(json::parse(status.output)["rate_asked"], 0);
  const Outcome snapshot = merlin({"snapshot", "-o", dir_ / "frame.png"});
  EXPECT_EQ(snapshot.status, 0) << snapshot.output;
  EXPECT_TRUE(fs::is_regular_file(dir_ / "frame.png"));
  EXPECT_EQ(devices->kill(SIGTERM), 0) << devices->output();
  EXPECT_EQ(wall->kill(SIGTERM), 0) << wall->output();
}

// The drop-ins files.conf allow /srv/merlin, which is a folder inside the test's folder here.
TEST_F(Install, AFolderOfOnesOwnIsForbiddenByTheUnitsAndAllowedByTheirDropIns) {
  if (::geteuid() != 0 || run({"unshare", "--mount", "true"}).status != 0)
    GTEST_SKIP() << "this user cannot make files read-only by mounts";
  const std::string folder = dir_ / "srv/merlin";
  fs::create_directories(folder);
  ASSERT_EQ(::chown(folder.c_str(), kNobody, kNobody), 0);
  const json settings = {{"devices", {{"serve", {{"spnav_socket", folder + "/spnav.sock"}}}}},
                         {"wall", {{"wall", {{"snapshots", folder}}}}}};
  for (const auto& [role, patch] : settings.items()) {
    const std::string config = configuration(patch);
    const auto started = [&, &role = role](const std::vector<std::string>& drop_ins) {
      auto command = underUnit({merlind_, "--role", role, "--last-good", "--config", config},
                               "merlin-" + role + ".service", drop_ins);
      command.insert(command.begin() + 1, {"--in", dir_.path()});
      return std::make_unique<Process>(
          command, std::map<std::string, std::string>{{"STATE_DIRECTORY", runDirectory()}});
    };
    const auto alone = started({});
    EXPECT_NE(alone->wait(), 0) << role;
    EXPECT_NE(alone->output().find("Read-only file system"), std::string::npos) << alone->output();
    const auto allowed = started({"files.conf"});
    EXPECT_TRUE(allowed->saysEventually("ready")) << allowed->output();
    if (role == "devices") {
      EXPECT_TRUE(eventually([&] { return fs::is_socket(folder + "/spnav.sock"); }));
    }
    EXPECT_EQ(allowed->kill(SIGTERM), 0) << allowed->output();
  }
}

TEST_F(Install, TheInstalledMerlinRfbRunsUnderItsUnit) {
  if (!fs::exists(MERLIN_BIN_DIR "/merlin-rfb")) GTEST_SKIP() << "merlin-rfb is not built";
  EXPECT_FALSE(fs::exists(root_ + "/usr/bin/merlin-rfb")) << "it is a component of its own";
  ASSERT_EQ(install("merlin-rfb").status, 0);
  EXPECT_TRUE(fs::is_regular_file(root_ + "/usr/lib/sysusers.d/merlin-rfb.conf"));
  Process rfb(
      underUnit({root_ + "/usr/bin/merlin-rfb", "--instance", instance_, "--listen", "127.0.0.1:0"},
                "merlin-rfb.service"));
  ASSERT_TRUE(rfb.saysEventually("clients at most")) << rfb.output();
  const std::string said = rfb.output(), before = "at 127.0.0.1:";
  const int port = std::stoi(said.substr(said.find(before) + before.size()));
  const UniqueFd client = connected(port);
  char version[13] = {};
  EXPECT_EQ(::recv(client.get(), version, 12, MSG_WAITALL), 12) << rfb.output();
  EXPECT_STREQ(version, "RFB 003.008\n");
  EXPECT_EQ(rfb.kill(SIGTERM), 0) << rfb.output();
}

// The alarms' process under its unit's restrictions, with a device that is absent from the start.
// The alarm starts `program` with a file name as its argument; the program may write that file.
class InstalledAlarms : public Install {
 protected:
  void startWith(const std::string& program, const std::vector<std::string>& drop_ins = {}) {
    const std::string path = dir_ / "tell";
    writeText(path, program);
    ASSERT_EQ(::chmod(path.c_str(), 0755), 0);
    const std::string config = configuration(
        {{"devices", {deviceEntry("ball", "spaceball", "serial:/dev/serial/by-id/none")}},
         {"alarms", {{{"run", {path, told_}}, {"kinds", {"device"}}}}}});
    const Outcome checked = run({merlind_, "--role", "alarms", "--check-config", config});
    ASSERT_EQ(checked.status, 0) << checked.output;
    devices_ = start("devices", config);
    alarms_ = start("alarms", config, drop_ins);
  }
  bool tells(const std::string& text) {
    return eventually([&] { return readText(told_).find(text) != std::string::npos; });
  }

  std::string told_ = runDirectory() + "/told";
  std::unique_ptr<Process> devices_, alarms_;
};

// A mailer calls chown, which the unit forbids, and continues when the call fails.
TEST_F(InstalledAlarms, AProgramThatCallsWhatTheUnitForbidsGetsAnError) {
  startWith(
      "#!/bin/sh\n: >>\"$1\"\nchown 12345 \"$1\" 2>/dev/null\n"
      "echo \"chown ended with $?\" >>\"$1\"\ncat >>\"$1\"\n"
      "grep NoNewPrivs /proc/self/status >>\"$1\"\n");
  EXPECT_TRUE(tells("NoNewPrivs:\t1")) << readText(told_) << alarms_->output();
  EXPECT_TRUE(tells("chown ended with 1\n")) << readText(told_) << "159: it was killed by SIGSYS";
  EXPECT_TRUE(tells("ball: absent")) << readText(told_);
}

// A setuid sendmail gains its privileges only if no system-call filter is installed.
TEST_F(InstalledAlarms, WithTheDropInForMailAProgramMayGainPrivileges) {
  startWith("#!/bin/sh\ncat >>\"$1\"\ngrep -E 'NoNewPrivs|Seccomp:' /proc/self/status >>\"$1\"\n",
            {"mail.conf"});
  EXPECT_TRUE(tells("NoNewPrivs:\t0")) << readText(told_) << alarms_->output();
  EXPECT_TRUE(tells("ball: absent")) << readText(told_);
  const std::string seccomp = readText("/proc/self/status");
  const auto at = seccomp.find("Seccomp:");  // A container may have installed a filter of its own.
  ASSERT_NE(at, std::string::npos);
  EXPECT_TRUE(tells(seccomp.substr(at, seccomp.find('\n', at) - at))) << readText(told_);
}

// The program that daemon/alarms/README.md recommends, with the address of a local server.
TEST_F(InstalledAlarms, TheProgramOfTheDocumentReachesAServerUnderTheUnit) {
  if (run({"which", "curl"}).status != 0) GTEST_SKIP() << "curl is not installed";
  const std::string document = readText(kSource + "/daemon/alarms/README.md");
  const auto lines = namedIn(document, "    (exec curl [^\n]+) https://");
  ASSERT_EQ(lines.size(), 1u);
  const LocalSocket server;
  ASSERT_GT(server.port, 0);
  ASSERT_EQ(::listen(server.fd.get(), 4), 0);
  startWith("#!/bin/sh\n" + *lines.begin() + " http://localhost:" + std::to_string(server.port) +
            "/wall\n");
  const timeval patience{60, 0};
  ASSERT_EQ(::setsockopt(server.fd.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience), 0);
  const UniqueFd client(::accept(server.fd.get(), nullptr, nullptr));
  ASSERT_TRUE(client.valid()) << alarms_->output();
  std::string request;
  char buffer[4096];
  while (request.find("left_out") == std::string::npos) {
    const ssize_t n = ::recv(client.get(), buffer, sizeof buffer, 0);
    if (n <= 0) break;
    request.append(buffer, static_cast<std::size_t>(n));
  }
  EXPECT_TRUE(request.starts_with("POST /wall ")) << request;
  EXPECT_NE(request.find("\"what\": \"ball: absent"), std::string::npos) << request;
}

// Objects that killed merlinds leave in shared memory are removed, whatever their instance name;
// other programs' files remain.
TEST(Purge, TakesWhatAKilledMerlindLeftInSharedMemory) {
  const TempDir root;
  fs::create_directories(root / "etc");
  fs::create_directories(root / "dev/shm");
  const std::string mine = std::to_string(::geteuid());
  writeText(root / "etc/passwd", "root:x:77777:0::/:/bin/sh\nmerlin:x:" + mine + ":1::/:/bin/sh\n");
  for (const char* name : {"merlin-wall", "merlin-wall.lock", "merlin-signal-3", "lab-devices",
                           "lab-framebuffer.lock", "lab-signal-0", "notes", "sem.other"})
    writeText(root / ("dev/shm/" + std::string(name)), "x");
  const std::string postrm = kSource + "/systemd/packages/merlin.postrm";
  const auto left = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(root / "dev/shm"))
      names.insert(entry.path().filename());
    return names;
  };
  ASSERT_EQ(run({"env", "DPKG_ROOT=" + root.path(), "sh", postrm, "remove"}).status, 0);
  EXPECT_EQ(left().size(), 8u);
  const Outcome purged = run({"env", "DPKG_ROOT=" + root.path(), "sh", postrm, "purge"});
  EXPECT_EQ(purged.status, 0) << purged.output;
  EXPECT_EQ(left(), (std::set<std::string>{"notes", "sem.other"}));
  writeText(root / "etc/passwd", "merlin:x:77777:1::/:/bin/sh\n");
  writeText(root / "dev/shm/merlin-wall", "another user's");
  EXPECT_EQ(run({"env", "DPKG_ROOT=" + root.path(), "sh", postrm, "purge"}).status, 0);
  EXPECT_TRUE(left().contains("merlin-wall"));
}

class InstalledServers : public Install {
 protected:
  void SetUp() override {
    Install::SetUp();
    ASSERT_EQ(run({kMerlin, "keys", "-o", dir_ / "keys"}).status, 0);
    // The keys belong to the daemon's user, and no other user can read them.
    if (::geteuid() == 0) {
      ASSERT_EQ(::chown((dir_ / "keys").c_str(), kNobody, kNobody), 0);
    }
    writeText(dir_ / "clients", "");
    vrpn_ = freePort();
    samples_ = freePort();
    config_ = configuration({{"serve",
                              {{"vrpn_port", vrpn_},
                               {"samples_endpoint", "tcp://127.0.0.1:" + std::to_string(samples_)},
                               {"samples_keys", dir_ / "keys"},
                               {"samples_clients", dir_ / "clients"}}}});
  }

  int vrpn_ = 0, samples_ = 0;
  std::string config_;
};

TEST_F(InstalledServers, AreSaidToBeForbiddenAndTheDevicesAreRead) {
  const auto devices = start("devices", config_);
  for (const char* what : {"VRPN: failed (/serve/vrpn_port: network sockets are forbidden",
                           "samples for other machines: failed (/serve/samples_endpoint: network "
                           "sockets are forbidden",
                           "drop-in network.conf"}) {
    EXPECT_TRUE(devices->saysEventually(what)) << devices->output();
  }
  const Outcome status = merlin({"status", "--json"});
  ASSERT_EQ(status.status, 0) << status.output;
  const json servers = json::parse(status.output)["servers"];
  EXPECT_EQ(servers["VRPN"]["state"], "failed") << status.output;
  EXPECT_EQ(servers["samples for other machines"]["state"], "failed") << status.output;
  EXPECT_EQ(devices->kill(SIGTERM), 0);
}

TEST_F(InstalledServers, OfTheWallAreForbiddenToItAndServedWithItsDropIn) {
  const int port = freePort();
  const std::string config =
      configuration({{"serve",
                      {{"wall_endpoint", "tcp://127.0.0.1:" + std::to_string(port)},
                       {"commands_keys", dir_ / "keys"},
                       {"commands_clients", dir_ / "clients"}}}});
  auto wall = start("wall", config);
  EXPECT_TRUE(wall->saysEventually(
      "commands of the wall over the network: failed (/serve/wall_endpoint: network sockets are "
      "forbidden"))
      << wall->output();
  EXPECT_FALSE(connects(port));
  EXPECT_EQ(wall->kill(SIGTERM), 0);
  wall = start("wall", config, {"network.conf"});
  EXPECT_TRUE(eventually([&] { return connects(port); })) << wall->output();
  EXPECT_EQ(wall->output().find("failed (/serve"), std::string::npos) << wall->output();
  EXPECT_EQ(wall->kill(SIGTERM), 0);
}

TEST_F(InstalledServers, AreServedWithTheDropIn) {
  const auto devices = start("devices", config_, {"network.conf"});
  EXPECT_TRUE(connects(vrpn_)) << devices->output();
  EXPECT_TRUE(connects(samples_)) << devices->output();
  EXPECT_EQ(devices->output().find("failed (/serve"), std::string::npos) << devices->output();
  EXPECT_EQ(devices->kill(SIGTERM), 0);
}

}  // namespace
}  // namespace merlin::test
