// Follows MERLIN's space ball from a C++20 program that includes the layout, and prints each sample
// with its time of day: read_merlin_cpp SEGMENT COUNT, SEGMENT as "merlin-devices". No library of
// MERLIN's is needed. Build, at the top of the source tree:
//     g++ -std=c++20 -O2 -I. daemon/shm/read_merlin.cpp -o read_merlin_cpp
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/shm/layout.h"

using merlin::shm::DevicesSegment;

// Maps the segment read-only; null if there is none that this program knows.
static const DevicesSegment* map(const std::string& name) {
  const int fd = ::open(("/dev/shm/" + name).c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (fd < 0 || ::fstat(fd, &status) != 0) return nullptr;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* memory = size < sizeof(DevicesSegment)
                     ? MAP_FAILED
                     : ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd, 0);
  ::close(fd);
  if (memory == MAP_FAILED) return nullptr;
  const auto* segment = static_cast<const DevicesSegment*>(memory);
  const auto& header = segment->header;
  const bool known = header.magic == merlin::shm::kMagic && header.version == merlin::shm::kVersion;
  return known ? segment : nullptr;
}

int main(int argc, char** argv) {
  const DevicesSegment* segment = argc == 3 ? map(argv[1]) : nullptr;
  if (segment == nullptr) {
    std::fprintf(stderr, "usage: read_merlin_cpp SEGMENT COUNT; SEGMENT as merlin-devices\n");
    return 2;
  }
  const auto& ball = segment->ball;
  std::uint64_t next = ball.count();
  const std::uint64_t end = next + std::strtoull(argv[2], nullptr, 10);
  while (next < end) {
    ball.wait(next, {.tv_sec = 2, .tv_nsec = 0});  // returns as soon as there is a sample `next`
    if (ball.count() == next) {
      std::fprintf(stderr, "read_merlin_cpp: no sample for 2 s\n");
      return 1;
    }
    for (; next < ball.count() && next < end; ++next) {
      const auto sample = ball.at(next);
      if (!sample) continue;  // more than 256 samples behind: it was overwritten
      const double utc_s =
          1e-9 * static_cast<double>(sample->received_ns + segment->header.realtime_offset_ns);
      std::printf("ball %llu at %.3f: %g %g %g\n", static_cast<unsigned long long>(next), utc_s,
                  static_cast<double>(sample->rotation[0]),
                  static_cast<double>(sample->rotation[1]),
                  static_cast<double>(sample->rotation[2]));
    }
  }
  return 0;
}
