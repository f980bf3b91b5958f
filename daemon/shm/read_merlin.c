/* Prints values from MERLIN's shared memory, by the table that it carries, and waits for the next
 * sample: read_merlin SEGMENT FIELD ... [--follow CHANNEL COUNT]. Plain C99, no header of MERLIN's.
 * Build: cc -std=gnu99 -O2 read_merlin.c -o read_merlin */
#include <fcntl.h>
#include <linux/futex.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

struct field { char name[40], unit[16], type[4]; uint32_t count, offset, slot; };
struct header {
  uint32_t magic, version; uint64_t size, generation; int64_t heartbeat_ns, started_ns;
  uint32_t pid, field_count; char status_endpoint[108], command_endpoint[108]; struct field fields[];
};

static const char* memory;

static uint64_t word(uint32_t offset) {
  return __atomic_load_n((const uint64_t*)(memory + offset), __ATOMIC_ACQUIRE);
}

static size_t width(char type) { return type == 's' || type == 'B' ? 1 : type == 'h' ? 2
                                      : type == 'q' || type == 'Q' || type == 'd' ? 8 : 4; }

/* Copies a field whole: its slot's sequence is even, and the same before and after. At most 1000
 * tries, so that a writer that died in the middle of one costs no more than that. */
static int copy_field(const struct field* f, void* to, size_t most) {
  size_t bytes = width(f->type[0]) * f->count;
  if (bytes > most) return 0;
  for (int i = 0; i < 1000; ++i) {
    uint64_t before = f->slot ? word(f->slot) : 2;
    memcpy(to, memory + f->offset, bytes);
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (before && before % 2 == 0 && (!f->slot || word(f->slot) == before)) return 1;
  }
  return 0;
}

static void print_field(const struct field* f) {
  char value[4096];
  printf("%s", f->name);
  if (!copy_field(f, value, sizeof value)) { puts(" -"); return; }
  if (f->type[0] == 's') { printf(" %.*s\n", (int)f->count, value); return; }
  for (uint32_t i = 0; i < f->count; ++i) {
    const char* at = value + i * width(f->type[0]);
    switch (f->type[0]) {
      case 'q': { int64_t v; memcpy(&v, at, 8); printf(" %lld", (long long)v); break; }
      case 'Q': { uint64_t v; memcpy(&v, at, 8); printf(" %llu", (unsigned long long)v); break; }
      case 'i': { int32_t v; memcpy(&v, at, 4); printf(" %d", v); break; }
      case 'I': { uint32_t v; memcpy(&v, at, 4); printf(" %u", v); break; }
      case 'h': { int16_t v; memcpy(&v, at, 2); printf(" %d", v); break; }
      case 'B': printf(" %u", (unsigned char)*at); break;
      case 'f': { float v; memcpy(&v, at, 4); printf(" %.6g", (double)v); break; }
      case 'd': { double v; memcpy(&v, at, 8); printf(" %.9g", v); break; }
    }
  }
  printf(" %s\n", f->unit);
}

static const struct field* find(const struct header* h, const char* name) {
  for (uint32_t i = 0; i < h->field_count; ++i)
    if (strncmp(h->fields[i].name, name, sizeof h->fields[i].name) == 0) return &h->fields[i];
  fprintf(stderr, "read_merlin: the segment has no field %s\n", name);
  exit(2);
}

/* Sleeps on CHANNEL.wake until CHANNEL.count has grown by `count`; a dead daemon ends it. */
static void follow(const struct header* h, const char* channel, uint64_t count) {
  char name[64];
  snprintf(name, sizeof name, "%s.count", channel);
  const struct field* counter = find(h, name);
  snprintf(name, sizeof name, "%s.wake", channel);
  const uint32_t* wake = (const uint32_t*)(memory + find(h, name)->offset);
  for (uint64_t first = word(counter->offset), seen = first; seen < first + count;) {
    uint32_t before = __atomic_load_n(wake, __ATOMIC_ACQUIRE);
    struct timespec limit = {2, 0};
    if (word(counter->offset) == seen && syscall(SYS_futex, wake, FUTEX_WAIT, before, &limit, 0, 0) &&
        word(counter->offset) == seen) { fprintf(stderr, "read_merlin: no sample for 2 s\n"); exit(1); }
    for (uint64_t now = word(counter->offset); seen < now; ++seen) printf("%s %llu\n", channel, (unsigned long long)seen);
  }
}

int main(int argc, char** argv) {
  char path[256];
  struct stat status;
  if (argc < 3) { fprintf(stderr, "usage: read_merlin SEGMENT FIELD ... | --follow CHANNEL COUNT\n"); return 2; }
  snprintf(path, sizeof path, "/dev/shm/%s", argv[1]);
  int fd = open(path, O_RDONLY);
  if (fd < 0 || fstat(fd, &status) != 0) { perror(path); return 2; }
  memory = mmap(0, (size_t)status.st_size, PROT_READ, MAP_SHARED, fd, 0);
  const struct header* h = (const struct header*)memory;
  if (memory == MAP_FAILED || h->magic != 0x4E4C524D || h->version != 1) {
    fprintf(stderr, "read_merlin: %s is no segment of MERLIN's that this program knows\n", path);
    return 2;
  }
  for (int i = 2; i < argc; ++i) {
    if (strcmp(argv[i], "--follow") == 0 && i + 2 < argc) { follow(h, argv[i + 1], strtoull(argv[i + 2], 0, 10)); i += 2; }
    else print_field(find(h, argv[i]));
  }
  return 0;
}
