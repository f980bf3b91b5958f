// Makes image pyramids in memory, in the TIFF form that MERLIN reads, and gives random access to
// their bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <zlib.h>

#include "render/image/pyramid_file.h"

namespace merlin::test {

class MemoryAccess final : public render::image::RandomAccess {
 public:
  explicit MemoryAccess(std::string bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t size() const noexcept override { return bytes_.size(); }
  Result<Ok> read(std::uint64_t offset, std::span<std::uint8_t> to) const override {
    if (offset > bytes_.size() || to.size() > bytes_.size() - offset)
      return Error{Errc::kMalformed, "ends too early"};
    std::memcpy(to.data(), bytes_.data() + offset, to.size());
    return Ok{};
  }

 private:
  std::string bytes_;
};

using Rgb = std::array<std::uint8_t, 3>;

struct PyramidSpec {
  int width = 600, height = 300, tile = 256;
  std::function<Rgb(int, int)> colour = [](int x, int y) {
    return Rgb{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 128};
  };
  // true: directories of the reduced levels are subdirectories of the first one; false: one follows
  // another
  bool subdirectories = false;
  std::string description = "MERLIN picture";
};

namespace detail {

inline void put(std::string& to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to.push_back(static_cast<char>(value >> (8 * i) & 0xFF));
}
inline void putAt(std::string& to, std::size_t at, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) to[at + i] = static_cast<char>(value >> (8 * i) & 0xFF);
}

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  const std::uint8_t* at(int x, int y) const {
    return &rgb[3 * static_cast<std::size_t>(y * width + x)];
  }
};

inline Pixels halved(const Pixels& whole) {
  Pixels half{std::max(1, whole.width / 2), std::max(1, whole.height / 2), {}};
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const int right = std::min(2 * x + 1, whole.width - 1),
                below = std::min(2 * y + 1, whole.height - 1);
      for (int k = 0; k < 3; ++k) {
        const int sum = whole.at(2 * x, 2 * y)[k] + whole.at(right, 2 * y)[k] +
                        whole.at(2 * x, below)[k] + whole.at(right, below)[k];
        half.rgb.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
      }
    }
  }
  return half;
}

// Appends the tiles of a level to the file; returns each tile's offset and size in bytes.
inline std::vector<std::array<std::uint64_t, 2>> putTiles(std::string& file, const Pixels& level,
                                                          int tile) {
  std::vector<std::array<std::uint64_t, 2>> places;
  const auto n = static_cast<std::size_t>(tile);
  for (int top = 0; top < level.height; top += tile) {
    for (int left = 0; left < level.width; left += tile) {
      std::vector<std::uint8_t> bytes(3 * n * n);  // the tile is black beyond the picture's edges
      for (int y = top; y < std::min(top + tile, level.height); ++y) {
        const int width = std::min(tile, level.width - left);
        std::copy_n(level.at(left, y), 3 * width,
                    &bytes[3 * static_cast<std::size_t>(y - top) * n]);
      }
      uLongf size = compressBound(bytes.size());
      std::string packed(size, '\0');
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size, bytes.data(), bytes.size(), 1);
      places.push_back({file.size(), size});
      file.append(packed, 0, size);
    }
  }
  return places;
}

// Collects the entries of a TIFF directory and writes it. Values longer than 8 bytes are appended
// to the file before the directory.
class DirectoryWriter {
 public:
  explicit DirectoryWriter(std::string& file) : file_(file) {}
  void number(int tag, int type, std::uint64_t value) {
    std::string entry;
    head(entry, tag, type, 1);
    put(entry, value, 8);
    entries_.push_back(entry);
  }
  void list(int tag, const std::vector<std::uint64_t>& values) {
    std::string bytes;
    for (const std::uint64_t v : values) put(bytes, v, 8);
    block(tag, 16, values.size(), bytes);
  }
  void block(int tag, int type, std::uint64_t count, std::string bytes) {
    std::string entry;
    head(entry, tag, type, count);
    if (bytes.size() > 8) {
      put(entry, file_.size(), 8);
      file_ += bytes;
    } else {
      bytes.resize(8, '\0');
      entry += bytes;
    }
    entries_.push_back(entry);
  }
  // Appends the directory to the file; returns its offset. The directory's "next" field is then the
  // last 8 bytes of the file.
  std::uint64_t write() {
    const std::uint64_t at = file_.size();
    put(file_, entries_.size(), 8);
    for (const std::string& entry : entries_) file_ += entry;
    put(file_, 0, 8);
    return at;
  }

 private:
  static void head(std::string& entry, int tag, int type, std::uint64_t count) {
    put(entry, static_cast<std::uint64_t>(tag), 2);
    put(entry, static_cast<std::uint64_t>(type), 2);
    put(entry, count, 8);
  }
  std::string& file_;
  std::vector<std::string> entries_;
};

inline std::uint64_t putDirectory(std::string& file, const Pixels& level, const PyramidSpec& spec,
                                  const std::vector<std::uint64_t>& subdirectories, bool first) {
  const auto places = putTiles(file, level, spec.tile);
  std::vector<std::uint64_t> offsets, sizes;
  for (const auto& [offset, size] : places) {
    offsets.push_back(offset);
    sizes.push_back(size);
  }
  DirectoryWriter d(file);
  d.number(254, 4, first ? 0 : 1);
  d.number(256, 4, static_cast<std::uint64_t>(level.width));
  d.number(257, 4, static_cast<std::uint64_t>(level.height));
  d.block(258, 3, 3, std::string("\10\0\10\0\10\0", 6));
  d.number(259, 3, 8);
  d.number(262, 3, 2);
  if (first) d.block(270, 2, spec.description.size() + 1, spec.description + std::string(1, '\0'));
  d.number(277, 3, 3);
  d.number(284, 3, 1);
  d.number(322, 3, static_cast<std::uint64_t>(spec.tile));
  d.number(323, 3, static_cast<std::uint64_t>(spec.tile));
  d.list(324, offsets);
  d.list(325, sizes);
  if (first && !subdirectories.empty()) d.list(330, subdirectories);
  return d.write();
}

}  // namespace detail

// Returns the bytes of a BigTIFF pyramid with deflate-compressed tiles.
inline std::string pyramidBytes(const PyramidSpec& spec = {}) {
  std::vector<detail::Pixels> levels{{spec.width, spec.height, {}}};
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      const Rgb c = spec.colour(x, y);
      levels[0].rgb.insert(levels[0].rgb.end(), c.begin(), c.end());
    }
  }
  while (levels.back().width > spec.tile || levels.back().height > spec.tile)
    levels.push_back(detail::halved(levels.back()));
  std::string file = std::string("II\53\0\10\0\0\0", 8) + std::string(8, '\0');
  std::vector<std::uint64_t> subs;
  std::size_t next = 8;  // where the offset of the next directory has to be written
  const auto putLevel = [&](std::size_t i) {
    const std::uint64_t at =
        detail::putDirectory(file, levels[i], spec, i == 0 ? subs : decltype(subs){}, i == 0);
    if (i > 0 && spec.subdirectories) return subs.push_back(at);
    detail::putAt(file, next, at);
    next = file.size() - 8;
  };
  for (std::size_t i = 1; spec.subdirectories && i < levels.size(); ++i) putLevel(i);
  putLevel(0);
  for (std::size_t i = 1; !spec.subdirectories && i < levels.size(); ++i) putLevel(i);
  return file;
}

// Returns the offset of a field's value; `directory` is the offset of the directory that has the
// field.
inline std::size_t fieldAt(const std::string& bytes, std::size_t directory, int tag) {
  for (std::size_t at = directory + 8;; at += 20) {
    const int found =
        static_cast<unsigned char>(bytes[at]) | static_cast<unsigned char>(bytes[at + 1]) << 8;
    if (found == tag) return at + 12;
  }
}

inline std::size_t numberAt(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 8; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// Returns the offsets of all directories of a file whose levels follow one another.
inline std::vector<std::size_t> directoriesOf(const std::string& bytes) {
  std::vector<std::size_t> all;
  for (std::size_t at = numberAt(bytes, 8); at != 0;) {
    all.push_back(at);
    at = numberAt(bytes, at + 8 + 20 * numberAt(bytes, at));
  }
  return all;
}

inline Result<std::shared_ptr<const render::image::PyramidFile>> readPyramid(std::string bytes) {
  return render::image::PyramidFile::read(std::make_unique<MemoryAccess>(std::move(bytes)),
                                          "test.tif");
}

}  // namespace merlin::test
