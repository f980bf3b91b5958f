// Example of a C++20 client that includes layout.h: follows the space ball and prints COUNT samples
// with their time. Usage: read_merlin_cpp SEGMENT COUNT, where SEGMENT is e.g. "merlin-devices". It
// needs no library of MERLIN. To build it, run at the top of the source tree:
//     g++ -std=c++20 -O2 -I. daemon/shm/read_merlin.cpp -o read_merlin_cpp
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/shm/layout.h"

using merlin::BallSample;
using merlin::shm::Channel;
using merlin::shm::Field;
using merlin::shm::Header;

// A mapped segment. All members are null or 0 if it could not be mapped or has an unknown layout.
struct Segment {
  const char* bytes = nullptr;
  std::uint64_t size = 0;
  const Header* header = nullptr;
};

static Segment map(const std::string& name) {
  const int fd = ::open(("/dev/shm/" + name).c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (fd < 0 || ::fstat(fd, &status) != 0) return {};
  const auto size = static_cast<std::uint64_t>(status.st_size);
  void* memory =
      size < sizeof(Header) ? MAP_FAILED : ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd, 0);
  ::close(fd);
  if (memory == MAP_FAILED) return {};
  const auto* header = static_cast<const Header*>(memory);
  const bool known =
      header->magic == merlin::shm::kMagic && header->version == merlin::shm::kVersion &&
      header->field_size >= sizeof(Field) &&
      header->field_offset + std::uint64_t{header->field_count} * header->field_size <= size;
  return known ? Segment{static_cast<const char*>(memory), size, header} : Segment{};
}

// Returns the channel whose samples have this name in the table of fields; null if there is none,
// or if its samples have another size than T. The offset of a channel may differ between releases,
// so it is taken from the table.
template <typename T>
static const Channel<T>* find(const Segment& segment, const std::string& name) {
  for (std::uint32_t i = 0; segment.header && i < segment.header->field_count; ++i) {
    const auto* field = reinterpret_cast<const Field*>(
        segment.bytes + segment.header->field_offset + std::size_t{i} * segment.header->field_size);
    if (name + ".received_ns" != field->name) continue;
    const bool fits = field->ring_stride == sizeof(merlin::shm::SeqSlot<T>) &&
                      field->ring_slots == merlin::shm::kHistory &&
                      field->slot % alignof(Channel<T>) == 0 &&
                      field->slot + sizeof(Channel<T>) <= segment.size;
    return fits ? reinterpret_cast<const Channel<T>*>(segment.bytes + field->slot) : nullptr;
  }
  return nullptr;
}

int main(int argc, char** argv) {
  const Segment segment = argc == 3 ? map(argv[1]) : Segment{};
  const Channel<BallSample>* found = find<BallSample>(segment, "ball");
  if (found == nullptr) {
    std::fprintf(stderr, "usage: read_merlin_cpp SEGMENT COUNT; SEGMENT as merlin-devices\n");
    return 2;
  }
  const Channel<BallSample>& ball = *found;
  std::uint64_t next = ball.count();
  const std::uint64_t end = next + std::strtoull(argv[2], nullptr, 10);
  while (next < end) {
    ball.wait(next, {.tv_sec = 2, .tv_nsec = 0});  // returns as soon as sample `next` is there
    if (ball.count() == next) {
      std::fprintf(stderr, "read_merlin_cpp: no sample for 2 s\n");
      return 1;
    }
    for (; next < ball.count() && next < end; ++next) {
      const auto sample = ball.at(next);
      if (!sample) continue;  // overwritten: this program is 256 samples behind
      const double utc_s =
          1e-9 * static_cast<double>(sample->received_ns + segment.header->realtime_offset_ns);
      std::printf("ball %llu at %.3f: %g %g %g\n", static_cast<unsigned long long>(next), utc_s,
                  static_cast<double>(sample->rotation[0]),
                  static_cast<double>(sample->rotation[1]),
                  static_cast<double>(sample->rotation[2]));
    }
  }
  return 0;
}
