// The content of merlin report: free of secrets, limited in size, and complete even if a part
// fails.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "daemon/cli/report/contents.h"
#include "daemon/cli/report/machine.h"
#include "daemon/cli/report/report_parts.h"
#include "daemon/cli/stop_signals.h"
#include "tests/support/eventually.h"
#include "tests/support/temp_dir.h"

namespace merlin::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::TempDir;
using test::writeText;
using Texts = std::vector<std::string>;

TEST(KnownSecrets, AreReplacedTheLongestFirst) {
  const KnownSecrets secrets(Texts{"pass", "password-9", "abc"});
  EXPECT_EQ(secrets.without("a password-9, a pass; abc"),
            // Secrets of three letters are not replaced, since such texts occur everywhere.
            "a (left out), a (left out); abc")
      << "the shorter one is part of the longer one";
  EXPECT_TRUE(secrets.isIn("xpassx"));
  EXPECT_FALSE(secrets.isIn("abc"));
}

TEST(KnownSecrets, AreFoundAsJsonAndMessagesWriteThem) {
  const KnownSecrets secrets(Texts{"say \"hi\"", "tab\there"});
  EXPECT_EQ(secrets.without(R"x({"name": "say \"hi\""})x"), R"x({"name": "(left out)"})x");
  EXPECT_EQ(secrets.without(R"x("tab\there", tab\x09here)x"), R"x("(left out)", (left out))x");
}

TEST(KnownSecrets, ComeFromTheFilesThatTheSettingsName) {
  const TempDir dir;
  writeText(dir / "left.password", "hunter-22\r\n");
  writeText(dir / "wall.keys", "public PUBLICKEY\nsecret SECRETKEY\n");
  writeText(dir / "page.token", "hunter-22-TOKEN\n");
  Settings settings;
  settings.devices.projectors.resize(2);
  settings.devices.projectors[0].password_file = dir / "left.password";
  // This is a password in the place of a file's name: there is no such file.
  settings.devices.projectors[1].password_file = dir / "typed-in-place";
  settings.serve.samples_keys = dir / "wall.keys";
  const KnownSecrets secrets(settings, {dir / "page.token", dir / "no-such-file"});
  EXPECT_EQ(secrets.without("hunter-22 PUBLICKEY SECRETKEY hunter-22-TOKEN typed-in-place"),
            "(left out) PUBLICKEY (left out) (left out) (left out)");
  EXPECT_EQ(secrets.without(dir / "left.password"), "(left out)");
  EXPECT_EQ(secrets.without("left.password"), "left.password") << "a file that exists";
}

TEST(ReportContents, HaveNoSecretsInFilesNamesAndSentences) {
  std::vector<CollectedPart> parts = {
      {"journal", "", {{{"journal-hunter.txt", "typed hunter"}}, {"hunter: no such file"}}},
      {"frame", "", {{{"frame.png", "hunter by chance"}}, {}}}};
  makeFit(parts, KnownSecrets(Texts{"hunter"}));
  EXPECT_EQ(parts[0].result.files[0].name, "journal-(left out).txt");
  EXPECT_EQ(parts[0].result.files[0].content, "typed (left out)");
  EXPECT_EQ(parts[0].result.missing[0], "(left out): no such file");
  EXPECT_EQ(parts[1].result.files[0].content, "hunter by chance") << "a picture stays whole";
}

TEST(ReportContents, ThatDoNotFitAreNamedAndLaterOnesThatDoStay) {
  std::vector<CollectedPart> parts = {
      {"a", "", {{{"a", std::string(600, 'a')}}, {}}},
      {"b", "", {{{"b", std::string(500, 'b')}, {"c", std::string(400, 'c')}}, {}}}};
  makeFit(parts, KnownSecrets(Texts{}), 1000);
  ASSERT_EQ(parts[1].result.files.size(), 1u);
  EXPECT_EQ(parts[1].result.files[0].name, "c");
  EXPECT_EQ(parts[1].result.missing, (Texts{"b: does not fit: a report has at most 0 MB"}));
}

TEST(ReportContents, TheReadmeSaysWhatIsInAndWhatIsMissing) {
  const std::vector<CollectedPart> parts = {
      {"status", "state of the roles", {{}, {"status.json: no merlind runs"}}},
      {"hardware", "the machine", {{{"hardware/hardware.txt", "CPU"}}, {}}}};
  const std::string readme = readmeText(parts, "today");
  EXPECT_NE(readme.find("made by `merlin report` at today"), std::string::npos);
  EXPECT_NE(readme.find("  hardware: the machine\n    hardware/hardware.txt, 3 bytes\n"),
            std::string::npos);
  EXPECT_EQ(readme.find("state of the roles"), std::string::npos) << "it has no file";
  EXPECT_NE(readme.find("What is missing, and why\n  status.json: no merlind runs\n"),
            std::string::npos);
  EXPECT_NE(readme.find("Passwords, secret keys"), std::string::npos);
}

TEST(ReportContents, FindingsDoNotQuoteTheFile) {
  const auto text = [](const std::string& json) {
    return findingsText("f.json", loadSettings(json, "/etc/merlin"));
  };
  EXPECT_EQ(text("{}"), "f.json: no findings\n");
  const std::string entry = text(R"({"projectors": ["hunter22"]})");
  EXPECT_TRUE(
      entry.starts_with("f.json:1: /projectors/0 is not understood (left out; see merlind "
                        "--check-config)\n"))
      << entry;
  EXPECT_EQ(entry.find("hunter22"), std::string::npos);
  EXPECT_EQ(text("{\n\"password\": \"hunter22\" \"x\"}").find("hunter22"), std::string::npos);
  EXPECT_EQ(text("\"hunter22\"").find("hunter22"), std::string::npos);
  EXPECT_EQ(text(R"({"password": "hunter22"})").find("hunter22"), std::string::npos);
  EXPECT_NE(text(R"({"password": "hunter22"})").find("/password is not a known setting"),
            std::string::npos);
  EXPECT_NE(text(R"({"wall": {"rate": {"rate_hz": 900}}})").find("is 900; allowed is"),
            std::string::npos)
      << "a number is no secret";
}

// Runs a part of the report with little time and few bytes.
class RunPart : public testing::Test {
 protected:
  Result<PartResult> run(const std::function<void(PartFolder&)>& collect,
                         Duration limit = seconds(60)) {
    return runPart({"part", true, limit, 1000, collect}, stop_.get(), mask_);
  }
  RunPart() {
    ::sigprocmask(SIG_SETMASK, nullptr, &mask_);
    stop_ = stopSignals();
  }
  ~RunPart() override { ::sigprocmask(SIG_SETMASK, &mask_, nullptr); }
  RunPart(const RunPart&) = delete;
  RunPart& operator=(const RunPart&) = delete;
  // Returns the report's files about the configuration merlin.json of the folder.
  std::vector<PackedFile> configurationFiles(const TempDir& dir) {
    const ReportSubject subject{dir / "merlin.json", loadSettingsFile(dir / "merlin.json"),
                                "merlin-report-none", dir.path()};
    auto result = runPart(reportParts(subject)[0].settings, stop_.get(), mask_);
    EXPECT_TRUE(result);
    return result ? std::move(result->files) : std::vector<PackedFile>();
  }
  // Runs a part that never ends with growing time limits, until it has had time to write its file,
  // however busy the machine is.
  PartResult runEnded(const std::function<void(PartFolder&)>& collect) {
    for (Duration limit = milliseconds(100); limit < seconds(100); limit *= 2) {
      auto result = run(collect, limit);
      EXPECT_TRUE(result);
      if (!result) break;
      EXPECT_EQ(
          result->missing.back(),
          fmt::format("part: was ended after {:.0f} s, before it was complete", toSeconds(limit)));
      if (result->files.size() == 1 && result->files[0].content.ends_with('\n')) return *result;
    }
    ADD_FAILURE() << "it has written nothing";
    return {};
  }

  sigset_t mask_{};
  UniqueFd stop_;
};

TEST_F(RunPart, TakesItsFilesAndWhatItLacks) {
  const auto result = run([](PartFolder& folder) {
    folder.put("b.txt", std::string("two"));
    folder.put("../a.txt", std::string("one"));
    folder.put("c.txt", Error{Errc::kIo, "the cable\nis out"});
  });
  ASSERT_TRUE(result) << result.error().what;
  ASSERT_EQ(result->files.size(), 2u);
  EXPECT_EQ(result->files[0].name, "part/_.._a.txt");
  EXPECT_EQ(result->files[1].content, "two");
  EXPECT_EQ(result->missing, (Texts{"c.txt: the cable\\x0ais out"}));
}

TEST_F(RunPart, ThatHangsIsEndedAndWhatItHasIsTaken) {
  const PartResult result = runEnded([](PartFolder& folder) {
    folder.put("a.txt", std::string("one\n"));
    for (;;) ::pause();
  });
  EXPECT_EQ(result.files.size(), 1u);
}

TEST_F(RunPart, WhatItHasStartedIsEndedToo) {
  const PartResult result = runEnded([](PartFolder& folder) {
    const auto ran = runInto(folder.path("pid"), {"sh", "-c", "sleep 1000 & echo $!; wait"});
    folder.lacks(ran ? "it ended" : ran.error().what);
  });
  ASSERT_EQ(result.files.size(), 1u);
  const std::string stat = fmt::format("/proc/{}/stat", std::stoi(result.files[0].content));
  EXPECT_TRUE(test::eventually([&] {
    const std::string text = test::readText(stat);
    // A zombie counts as ended too, since perhaps nobody has waited for it.
    return text.empty() || text.find(") Z") != std::string::npos;
  }));
}

// Names of secret files are removed because of the settings' meaning. This happens before known
// secrets are replaced.
TEST_F(RunPart, TheConfigurationLacksNamesOfFilesWithSecrets) {
  const TempDir dir;
  writeText(dir / "merlin.json",
            R"({"projectors": [{"name": "left", "address": "h", "password_file": "pw"}],
                "serve": {"samples_endpoint": "tcp://127.0.0.1:1", "samples_keys": "kk",
                          "samples_clients": "clients"}})");
  const std::vector<PackedFile> files = configurationFiles(dir);
  ASSERT_EQ(files.size(), 3u);
  for (const PackedFile& file : files) {
    EXPECT_EQ(file.content.find(dir / "pw"), std::string::npos) << file.name;
    EXPECT_EQ(file.content.find(dir / "kk"), std::string::npos) << file.name;
  }
  EXPECT_NE(files[2].content.find("\"password_file\": \"(left out)\""), std::string::npos)
      << files[2].name;
}

// An alarm's arguments may be tokens, even if they are given in the program's place.
TEST_F(RunPart, TheConfigurationLacksArgumentsOfAlarms) {
  const TempDir dir;
  writeText(dir / "merlin.json",
            R"({"alarms": [{"run": ["/usr/bin/tell", "--token", "t0ken-of-the-lab"]},
                           {"run": ["/usr/bin/curl https://chat/hook-of-the-lab"]}]})");
  const std::vector<PackedFile> files = configurationFiles(dir);
  ASSERT_EQ(files.size(), 3u);
  std::string all;
  for (const PackedFile& file : files) all += file.content;
  EXPECT_EQ(all.find("of-the-lab"), std::string::npos) << all;
  EXPECT_EQ(all.find("--token"), std::string::npos) << all;
  EXPECT_NE(all.find("/usr/bin/tell"), std::string::npos) << all;
  EXPECT_NE(all.find("/usr/bin/curl (left out)"), std::string::npos) << all;
}

TEST(KnownSecrets, AreArgumentsOfAlarmsThatAreLongEnough) {
  Settings settings;
  settings.alarms.resize(1);
  settings.alarms[0].run = {"/usr/bin/tell-somebody", "--token", "t0ken-of-the-lab"};
  const KnownSecrets secrets(settings, {});
  EXPECT_EQ(secrets.without("/usr/bin/tell-somebody --token t0ken-of-the-lab"),
            "/usr/bin/tell-somebody --token (left out)");
}

TEST_F(RunPart, ThatCrashesOrWritesTooMuchSaysSo) {
  const auto crashed = run([](PartFolder&) {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    ::raise(SIGKILL);
  });
  ASSERT_TRUE(crashed);
  EXPECT_EQ(crashed->missing, (Texts{"part: the process that collects it ended early"}));
  const auto large = run([](PartFolder& folder) {
    folder.put("large", std::string(1001, 'x'));
    folder.put("small", std::string(600, 'x'));
    folder.put("third", std::string(600, 'x'));
  });
  ASSERT_TRUE(large);
  ASSERT_EQ(large->files.size(), 1u);
  EXPECT_EQ(large->files[0].name, "part/small");
  ASSERT_EQ(large->missing.size(), 2u);
  EXPECT_NE(large->missing[0].find("File too large"), std::string::npos) << large->missing[0];
  EXPECT_EQ(large->missing[1],
            "part/third: does not fit: the files of this part may have 1000 bytes");
}

TEST_F(RunPart, AProgramThatIsNotInstalledIsNamed) {
  const auto result = run([](PartFolder& folder) {
    const auto ran = runInto(folder.path("out"), {"merlin-no-such-program"});
    folder.lacks(ran.error().what);
  });
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->files.empty());
  EXPECT_EQ(result->missing, (Texts{"the program merlin-no-such-program is not installed"}));
}

TEST_F(RunPart, EndsAtCtrlC) {
  ::kill(::getpid(), SIGINT);  // SIGINT is blocked, so it waits in the signal descriptor
  const auto result = run([](PartFolder&) {
    for (;;) ::pause();
  });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kClosed);
  signalfd_siginfo taken{};
  EXPECT_EQ(::read(stop_.get(), &taken, sizeof taken), static_cast<ssize_t>(sizeof taken));
}

// Returns the files of an archive, read by another program.
std::vector<PackedFile> unpack(const std::string& path) {
  std::vector<PackedFile> files;
  archive* const a = ::archive_read_new();
  ::archive_read_support_filter_gzip(a);
  ::archive_read_support_format_tar(a);
  if (::archive_read_open_filename(a, path.c_str(), 10240) == ARCHIVE_OK) {
    for (archive_entry* entry = nullptr; ::archive_read_next_header(a, &entry) == ARCHIVE_OK;) {
      std::string content(static_cast<std::size_t>(::archive_entry_size(entry)), '\0');
      ::archive_read_data(a, content.data(), content.size());
      files.push_back({::archive_entry_pathname(entry), content});
    }
  }
  ::archive_read_free(a);
  return files;
}

TEST(TarFile, HoldsFilesOfAnyNameLengthAndBytes) {
  const TempDir dir;
  const std::vector<PackedFile> files = {{"r/" + std::string(200, 'n') + ".txt", "text"},
                                         {"r/empty", ""},
                                         {"r/bytes", std::string("\0\xff\n", 3)}};
  ASSERT_TRUE(writeTarGz(dir / "r.tar.gz", files, 1000));
  const auto read = unpack(dir / "r.tar.gz");
  ASSERT_EQ(read.size(), 3u);
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(read[i].name, files[i].name);
    EXPECT_EQ(read[i].content, files[i].content);
  }
  namespace fs = std::filesystem;
  EXPECT_EQ(fs::status(dir / "r.tar.gz").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(writeTarGz(dir / "again.tar.gz", files, 1000));
  EXPECT_EQ(test::readText(dir / "r.tar.gz"), test::readText(dir / "again.tar.gz"));
}

TEST(TarFile, ThatCannotBeWrittenLeavesTheOldOne) {
  const TempDir dir;
  writeText(dir / "r.tar.gz", "old");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{100, before.rlim_max};
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string noise;
  for (unsigned i = 0, x = 1; i < 100000; ++i)
    noise += static_cast<char>((x = x * 69069 + 1) >> 24);
  const auto written = writeTarGz(dir / "r.tar.gz", std::vector<PackedFile>{{"n", noise}}, 0);
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  ASSERT_FALSE(written);
  EXPECT_EQ(test::readText(dir / "r.tar.gz"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1)
      << "nothing half-written beside it";
}

TEST(Machine, IsReadFromTheFilesOfTheSystem) {
  const TempDir root;
  namespace fs = std::filesystem;
  const auto put = [&](const std::string& path, const std::string& text) {
    fs::create_directories(fs::path(root / path).parent_path());
    writeText(root / path, text);
  };
  put("proc/cpuinfo", "processor\t: 0\nmodel name\t: Z80 at 4 MHz\n");
  put("proc/meminfo", "MemTotal:       64 kB\nMemAvailable:    3 kB\nSwapTotal:       0 kB\n");
  put("proc/bus/input/devices", "I: Bus=0003\nN: Name=\"Big Button\"\nH: Handlers=event0\n");
  put("proc/sys/kernel/ostype", "Linux\n");
  put("proc/sys/kernel/osrelease", "6.1\n");
  put("proc/7/maps",
      "7f00-7f01 r-xp 0 08:01 1  /usr/lib/libzmq.so.5.2.4\n7f02 r-xp 0 0 2 /bin/x\n");
  put("etc/os-release", "NAME=\"Debian\"\nPRETTY_NAME=\"Debian 12\"\n");
  put("sys/class/drm/card0-HDMI-A-1/status", "connected\n");
  put("sys/class/drm/card0-HDMI-A-1/enabled", "enabled\n");
  put("sys/class/drm/card0-HDMI-A-1/modes", "1920x1080\n800x600\n");
  put("sys/class/drm/card0-HDMI-A-1/edid", std::string("\0\xff", 2));
  put("sys/class/drm/card0/device/vendor", "0x8086\n");
  put("sys/bus/usb/devices/1-1/idVendor", "0403\n");
  put("sys/bus/usb/devices/1-1/product", "USB serial\n");
  fs::create_directories(root / "dev/serial/by-id");
  fs::create_symlink("../../ttyUSB0", root / "dev/serial/by-id/usb-FTDI_A1-if00");
  const std::string text = hardwareText(root.path());
  for (const char* const line :
       {"Z80 at 4 MHz", "64 kB in all, 3 kB available",
        "card0-HDMI-A-1: connected, enabled, modes 1920x1080 800x600\n",
        "card0: driver , PCI id 0x8086:", "1-1: id 0403:,  USB serial",
        "usb-FTDI_A1-if00 -> ttyUSB0\n", "Name=\"Big Button\"\nHandlers=event0\n",
        "PCI devices:\nnone is found\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  ASSERT_EQ(displayIds(root.path()).size(), 1u);
  EXPECT_EQ(displayIds(root.path())[0].name, "card0-HDMI-A-1.edid");
  EXPECT_EQ(librariesText(root.path(), "7"), "/usr/lib/libzmq.so.5.2.4\n");
  EXPECT_NE(versionsText(root.path()).find("kernel Linux 6.1"), std::string::npos);
  EXPECT_NE(versionsText(root.path()).find("distribution Debian 12\n"), std::string::npos);
}

}  // namespace
}  // namespace merlin::cli
