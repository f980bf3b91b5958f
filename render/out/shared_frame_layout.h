// The shared-memory framebuffer that other processes map: /NAME-framebuffer, read-only for clients.
//
// The writer fills three buffers in turn. A reader reads `newest`, copies that buffer, and then
// checks that the buffer's `sequence` has not changed: the writer returns to a buffer only after
// two more frames. Little-endian. Any change of a field's meaning increments kVersion; clients
// refuse a version that they do not know.
//
// The first 40 bytes and the table of fields behind the header have the same layout as in the other
// segments (daemon/shm/layout.h): a program that reads that table can read this segment as well.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "daemon/base/field_table.h"

namespace merlin::render::out::framebuffer {

inline constexpr std::uint32_t kMagic = 0x42464D4D;  // "MMFB" in memory
inline constexpr std::uint32_t kVersion = 4;
inline constexpr std::uint32_t kFormatRgba8 = 1;
inline constexpr std::size_t kBuffers = 3;
inline constexpr std::size_t kMostTiles = 32;
inline constexpr std::size_t kMostFields = 64;

struct TileRectangle {
  char name[16];                     // NUL-ended
  std::uint32_t kind;                // 0: part of the wall, 1: the operator's view
  std::int32_t x, y, width, height;  // in the frame [px], from its upper left corner
  std::int32_t wall_x, wall_y;       // upper left corner in the wall's picture [px]; -1: none
  std::uint32_t eye;                 // which eye it is drawn for: 0 both, 1 left, 2 right
};
static_assert(sizeof(TileRectangle) == 48);

struct Buffer {
  std::uint64_t offset;  // position of the pixels, from the segment's start [bytes]
  // Number of the frame in this buffer; 0 while it is being written.
  std::atomic<std::uint64_t> sequence;
  std::int64_t finished_ns;   // when the last pixel was drawn, CLOCK_MONOTONIC [ns]
  std::uint32_t cost;         // cost of the detail drawn, in the content's unit, e.g. triangles
  std::uint32_t full_detail;  // 1 if drawn at the finest detail
};
static_assert(sizeof(Buffer) == 32);

struct Header {
  std::uint32_t magic, version;
  std::uint64_t size;          // of the whole segment [bytes]
  std::uint64_t generation;    // new at each start of the daemon
  std::uint32_t field_offset;  // offset of the table of fields in the segment [bytes]
  std::uint32_t field_count;
  std::uint32_t field_size;  // size of one entry of that table [bytes]
  std::uint32_t pid;
  std::uint32_t width, height;  // of the frame [px]
  std::uint32_t stride;         // of a row [bytes]
  std::uint32_t format;
  std::uint32_t wall_width, wall_height;  // of the wall's picture [px]
  std::uint32_t tile_count;
  std::atomic<std::uint32_t> newest;  // index of the newest complete buffer
  Buffer buffers[kBuffers];
  TileRectangle tiles[kMostTiles];
};
static_assert(offsetof(Header, buffers) == 72 && sizeof(Header) == 72 + 96 + 1536);

// The part of the segment before the pixels.
struct Front {
  Header header;
  shm::Field fields[kMostFields];
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace merlin::render::out::framebuffer
