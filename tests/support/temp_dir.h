// What tests leave on the machine while they run: a temporary folder, which is removed with its
// TempDir, and shared memory under a private name, which is removed when the process ends.
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

// Returns a shared memory name, ending in `what`, that no other test process and no daemon uses.
std::string privateName(const std::string& what);

}  // namespace merlin::test
