// Defines the binary layout of an .mrm file, version 1. The layout is a contract: FORMAT.md
// describes it in words, and tests/render/mrm_file_test.cpp reads an old file. Values are
// little-endian, like every machine that MERLIN runs on; mrm_file.cpp asserts this.
#pragma once

#include <cstdint>

namespace merlin::render::lod::mrm {

inline constexpr char kMagic[8] = {'M', 'R', 'L', 'N', '.', 'm', 'r', 'm'};
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::uint64_t kAlignment = 64;  // alignment of each section's start [bytes]

enum class Kind : std::uint32_t {
  kPositions = 1,  // per node: f32 x 3
  kFeature = 2,    // per node: f32 x dimension; the section has the name of the feature
  kParents = 3,    // per collapse: u32
  kTriangles = 4,  // per triangle: u32 x 3
  kAlive = 5,      // per level: u32
  kError = 6,      // per level: f32
  kAbout = 7,      // u8: "key=value" lines of UTF-8 text
  // Kinds from 1000 (kFirstOptional) on are optional: a reader skips optional kinds that it does
  // not know. An unknown kind below 1000 is an error.
  kTexture = 1000,  // u8: a PNG or JPEG file
};
inline constexpr std::uint32_t kFirstOptional = 1000;

// Returns the size of one value of a section of this kind [bytes].
constexpr std::uint32_t unitOf(std::uint32_t kind) {
  return kind == static_cast<std::uint32_t>(Kind::kAbout) ||
                 kind == static_cast<std::uint32_t>(Kind::kTexture)
             ? 1
             : 4;
}

struct FileHeader {
  char magic[8];
  std::uint32_t version;
  std::uint32_t sections;
  std::uint64_t file_size;
  std::uint64_t nodes;
  std::uint64_t collapses;
  std::uint64_t triangles;
  float box_low[3], box_high[3];  // bounding box of all nodes, for readers of the header alone
  std::uint64_t table_checksum;   // XXH3-64 of the section table
  std::uint64_t header_checksum;  // XXH3-64 of this header up to here
};
static_assert(sizeof(FileHeader) == 88);

struct SectionEntry {
  std::uint32_t kind;
  std::uint32_t dimension;  // values per row
  std::uint64_t offset;     // from the start of the file [bytes]
  std::uint64_t rows;
  std::uint64_t checksum;  // XXH3-64 of the section's bytes
  char name[32];           // name of a feature, NUL-padded
};
static_assert(sizeof(SectionEntry) == 64);

}  // namespace merlin::render::lod::mrm
