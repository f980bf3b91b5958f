// What a test may leave on the machine: a temporary folder, which is removed with the object, and
// shared memory under a private name, which is removed at the process's end.
#pragma once

#include <string>

namespace merlin::test {

class TempDir {
 public:
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

void writeText(const std::string& path, const std::string& text);
std::string readText(const std::string& path);

// A shared memory name that no other test and no daemon uses.
std::string privateName(const std::string& what);

}  // namespace merlin::test
