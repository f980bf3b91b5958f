// TempDir: a temporary folder for one test, removed with the object.
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
    // A process that is ending may delete its own files at the same time: try again.
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

// A shared memory name that no other test and no daemon uses.
inline std::string privateName(const std::string& what) {
  return "merlin-test-" + std::to_string(::getpid()) + "-" + what;
}

}  // namespace merlin::test
