// TempDir: a folder of one test's own, gone with it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace merlin::test {

class TempDir {
 public:
  TempDir() {
    char name[] = "/tmp/merlin-test-XXXXXX";
    EXPECT_NE(::mkdtemp(name), nullptr);
    path_ = name;
  }
  ~TempDir() {
    // A process that is just ending takes its own files away at the same time.
    std::error_code error;
    do std::filesystem::remove_all(path_, error);
    while (error == std::errc::no_such_file_or_directory);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

inline void writeText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string readText(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// A name for shared memory that no other test, and no daemon, has.
inline std::string privateName(const std::string& what) {
  return "merlin-test-" + std::to_string(::getpid()) + "-" + what;
}

}  // namespace merlin::test
