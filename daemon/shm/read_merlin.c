/* Prints values from MERLIN's shared memory, using the table of fields in it, and follows a device
 * without missing a sample: read_merlin SEGMENT FIELD ... [--follow FIELD COUNT].
 * Plain C99, no header of MERLIN's. Build: cc -std=gnu99 -O2 read_merlin.c -o read_merlin */
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

/* daemon/base/field_table.h explains these members. */
struct field {
  char name[48], unit[24], type[8];
  uint32_t count, step, offset, slot, ring, ring_stride, ring_slots, reserved;
};
struct header { /* its first 40 bytes; the table describes the others */
  uint32_t magic, version; uint64_t size, generation;
  uint32_t field_offset, field_count, field_size, pid;
};

static const char* memory;

static uint64_t word(uint64_t offset) {
  return __atomic_load_n((const uint64_t*)(memory + offset), __ATOMIC_ACQUIRE);
}

/* Bytes of one value: a type is a letter, or "20s" for a text of 20 bytes. */
static size_t width(const char* type) {
  if (type[0] >= '0' && type[0] <= '9') return (size_t)atoi(type);
  return strchr("qQd", type[0]) ? 8 : strchr("iIf", type[0]) ? 4 : strchr("hH", type[0]) ? 2 : 1;
}

/* Copies the values at `from` consistently into `to`: the sequence number at `slot` is even, and the
 * same before and after. A field without a slot has no sequence number. At most 1000 tries, in case
 * the writer died while writing. Returns 0 if that fails or the value was never written. */
static int copy_values(const struct field* f, uint64_t slot, uint64_t from, void* to, size_t most) {
  size_t bytes = (f->count - 1) * (size_t)f->step + width(f->type);
  if (bytes > most) return 0;
  for (int i = 0; i < 1000; ++i) {
    uint64_t before = f->slot ? word(slot) : 2;
    memcpy(to, memory + from, bytes);
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (before && before % 2 == 0 && (!f->slot || word(slot) == before)) return 1;
  }
  return 0;
}

static void print_value(const char* type, const char* at) {
  switch (type[0]) {
    case 'q': { int64_t v; memcpy(&v, at, 8); printf(" %lld", (long long)v); break; }
    case 'Q': { uint64_t v; memcpy(&v, at, 8); printf(" %llu", (unsigned long long)v); break; }
    case 'i': { int32_t v; memcpy(&v, at, 4); printf(" %d", v); break; }
    case 'I': { uint32_t v; memcpy(&v, at, 4); printf(" %u", v); break; }
    case 'h': { int16_t v; memcpy(&v, at, 2); printf(" %d", v); break; }
    case 'H': { uint16_t v; memcpy(&v, at, 2); printf(" %u", v); break; }
    case 'B': printf(" %u", (unsigned char)*at); break;
    case 'f': { float v; memcpy(&v, at, 4); printf(" %.6g", (double)v); break; }
    case 'd': { double v; memcpy(&v, at, 8); printf(" %.9g", v); break; }
    default: printf(" %.*s", (int)width(type), at); /* a text */
  }
}

static void print_values(const struct field* f, const char* values) {
  for (uint32_t i = 0; i < f->count; ++i) print_value(f->type, values + (size_t)i * f->step);
  printf(" %s\n", f->unit);
}

static const struct field* find(const char* name) {
  const struct header* h = (const struct header*)memory;
  for (uint32_t i = 0; i < h->field_count; ++i) {
    const struct field* f = (const void*)(memory + h->field_offset + (size_t)i * h->field_size);
    if (strncmp(f->name, name, sizeof f->name) == 0) return f;
  }
  fprintf(stderr, "read_merlin: the segment has no field %s\n", name);
  exit(2);
}

static void print_newest(const struct field* f) {
  char values[4096];
  printf("%s", f->name);
  if (copy_values(f, f->slot, f->offset, values, sizeof values)) print_values(f, values);
  else puts(" -");
}

/* Prints sample number n of a channel, from its ring; `counter` is the field CHANNEL.count. Prints
 * "missed" if the sample was overwritten before it was read. */
static void print_sample(const struct field* f, const struct field* counter, uint64_t n) {
  char values[4096];
  uint64_t slot = f->ring + (n % f->ring_slots) * f->ring_stride;
  int whole = copy_values(f, slot, slot + (f->offset - f->slot), values, sizeof values);
  printf("%s %llu", f->name, (unsigned long long)n);
  if (whole && n + f->ring_slots > word(counter->offset)) print_values(f, values);
  else puts(" missed");
}

/* Prints FIELD of each of the next `count` samples of its channel. Sleeps on CHANNEL.wake. */
static void follow(const char* name, uint64_t count) {
  const struct field* f = find(name);
  const char* dot = strrchr(name, '.');
  char other[64];
  if (!f->ring || !dot) { fprintf(stderr, "read_merlin: %s has no ring\n", name); exit(2); }
  snprintf(other, sizeof other, "%.*s.count", (int)(dot - name), name);
  const struct field* counter = find(other);
  snprintf(other, sizeof other, "%.*s.wake", (int)(dot - name), name);
  const uint32_t* wake = (const uint32_t*)(memory + find(other)->offset);
  uint64_t seen = word(counter->offset), last = seen + count;
  while (seen < last) {
    uint32_t before = __atomic_load_n(wake, __ATOMIC_ACQUIRE); /* read before the count */
    struct timespec limit = {2, 0};
    if (word(counter->offset) == seen && syscall(SYS_futex, wake, FUTEX_WAIT, before, &limit, 0, 0) &&
        word(counter->offset) == seen) { fprintf(stderr, "read_merlin: no sample for 2 s\n"); exit(1); }
    for (uint64_t now = word(counter->offset); seen < now; ++seen) print_sample(f, counter, seen);
  }
}

int main(int argc, char** argv) {
  char path[256];
  struct stat status;
  if (argc < 3) { fprintf(stderr, "usage: read_merlin SEGMENT FIELD ... | --follow FIELD COUNT\n"); return 2; }
  snprintf(path, sizeof path, "/dev/shm/%s", argv[1]);
  int fd = open(path, O_RDONLY);
  if (fd < 0 || fstat(fd, &status) != 0) { perror(path); return 2; }
  memory = mmap(0, (size_t)status.st_size, PROT_READ, MAP_SHARED, fd, 0);
  const struct header* h = (const struct header*)memory;
  /* The second one is the frame buffer's. */
  if (memory == MAP_FAILED || (h->magic != 0x4E4C524D && h->magic != 0x42464D4D) || h->version != (h->magic == 0x4E4C524D ? 6u : 4u)) {
    fprintf(stderr, "read_merlin: %s is not a segment of MERLIN that this program knows\n", path);
    return 2;
  }
  for (int i = 2; i < argc; ++i) {
    if (strcmp(argv[i], "--follow") == 0 && i + 2 < argc) { follow(argv[i + 1], strtoull(argv[i + 2], 0, 10)); i += 2; }
    else print_newest(find(argv[i]));
  }
  return 0;
}
