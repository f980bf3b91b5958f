#include "tests/support/temp_dir.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace merlin::test {

namespace {

// Removes the shared memory of a test at the process's end. merlind leaves its shared memory behind
// for its readers, but that of a test has none any more.
class PrivateNames {
 public:
  PrivateNames() : pid_(::getpid()), prefix_("merlin-test-" + std::to_string(pid_) + "-") {}
  ~PrivateNames() {
    if (::getpid() != pid_) return;  // This is a child that was forked from the test.
    std::error_code error;
    std::vector<std::filesystem::path> left;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", error)) {
      if (entry.path().filename().string().starts_with(prefix_)) left.push_back(entry.path());
    }
    for (const auto& path : left) std::filesystem::remove(path, error);
  }
  PrivateNames(const PrivateNames&) = delete;
  PrivateNames& operator=(const PrivateNames&) = delete;

  std::string operator()(const std::string& what) const { return prefix_ + what; }

 private:
  pid_t pid_;
  std::string prefix_;
};

}  // namespace

TempDir::TempDir() {
  char name[] = "/tmp/merlin-test-XXXXXX";
  EXPECT_NE(::mkdtemp(name), nullptr);
  path_ = name;
}

TempDir::~TempDir() {
  // A process that is ending may delete its own files at the same time, so try again.
  std::error_code error;
  do std::filesystem::remove_all(path_, error);
  while (error == std::errc::no_such_file_or_directory);
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string readText(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string privateName(const std::string& what) {
  static const PrivateNames names;
  return names(what);
}

}  // namespace merlin::test
