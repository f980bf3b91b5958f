#include "render/image/tiff_directory.h"

#include <algorithm>
#include <cstring>
#include <span>

#include <fmt/format.h>

namespace merlin::render::image {
namespace {

constexpr std::uint64_t kMostEntries = 256;
constexpr std::uint64_t kMostText = 65'536;  // bytes of a description or of JPEG tables
constexpr std::uint64_t kMostSubdirectories = 40;
constexpr std::uint64_t kMostSamples = 16;
constexpr std::size_t kEntrySize = 20;

enum Tag : std::uint16_t {
  kWidth = 256,
  kHeight = 257,
  kBits = 258,
  kCompression = 259,
  kPhotometric = 262,
  kDescription = 270,
  kSamples = 277,
  kPlanar = 284,
  kPredictor = 317,
  kTileWidth = 322,
  kTileHeight = 323,
  kTileOffsets = 324,
  kTileSizes = 325,
  kSubdirectories = 330,
  kSampleFormat = 339,
  kJpegTables = 347,
};

std::uint64_t little(const std::uint8_t* p, int bytes) noexcept {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= std::uint64_t{p[i]} << (8 * i);
  return value;
}

// Returns the size of a value of a TIFF type [bytes]; 0 for a type that no field read here may
// have.
int sizeOf(std::uint16_t type) noexcept {
  switch (type) {
    case 1:
    case 2:
    case 7: return 1;  // BYTE, ASCII, UNDEFINED
    case 3: return 2;  // SHORT
    case 4:
    case 13: return 4;  // LONG, IFD
    case 16:
    case 18: return 8;  // LONG8, IFD8
    default: return 0;
  }
}

Error malformed(std::uint64_t offset, const std::string& what) {
  return {Errc::kMalformed, fmt::format("the directory at byte {}: {}", offset, what)};
}

// An entry of a directory: a field, and where its values lie.
struct Entry {
  std::uint16_t tag = 0;
  TiffTable values;
};

class Reader {
 public:
  Reader(const RandomAccess& file, std::uint64_t offset) : file_(file) {
    directory_.offset = offset;
  }

  Result<TiffDirectory> read() {
    std::array<std::uint8_t, 8> word{};
    const std::uint64_t at = directory_.offset;
    if (at > file_.size() || file_.size() - at < 8 + kEntrySize + 8)
      return malformed(at, fmt::format("lies beyond the file's {} bytes", file_.size()));
    if (const auto got = file_.read(at, word); !got) return malformed(at, got.error().what);
    const std::uint64_t entries = little(word.data(), 8);
    if (entries == 0 || entries > kMostEntries)
      return malformed(at,
                       fmt::format("has {} fields; 1 to {} are supported", entries, kMostEntries));
    std::vector<std::uint8_t> bytes(entries * kEntrySize + 8);
    if (const auto got = file_.read(at + 8, bytes); !got) return malformed(at, got.error().what);
    for (std::uint64_t i = 0; i < entries; ++i) {
      const std::size_t place = i * kEntrySize;
      if (const auto taken = take(&bytes[place], at + 8 + place); !taken) return taken.error();
    }
    directory_.next = little(&bytes[entries * kEntrySize], 8);
    return directory_;
  }

 private:
  // `at`: offset of the entry in the file.
  Result<Ok> take(const std::uint8_t* bytes, std::uint64_t at) {
    Entry entry{static_cast<std::uint16_t>(little(bytes, 2)), {}};
    if (!isWanted(entry.tag)) return Ok{};
    const auto type = static_cast<std::uint16_t>(little(bytes + 2, 2));
    entry.values = {at + 12, little(bytes + 4, 8), sizeOf(type)};
    if (entry.values.value_size == 0)
      return malformed(directory_.offset, fmt::format("field {} has the type {}", entry.tag, type));
    const auto size = static_cast<std::uint64_t>(entry.values.value_size);
    if (entry.values.count > 8 / size) entry.values.offset = little(bytes + 12, 8);
    const std::uint64_t room = file_.size();
    if (entry.values.count > room / size ||
        entry.values.offset > room - entry.values.count * size) {
      return malformed(
          directory_.offset,
          fmt::format("field {}: its {} values at byte {} end beyond the file's {} bytes",
                      entry.tag, entry.values.count, entry.values.offset, room));
    }
    return store(entry);
  }

  static bool isWanted(std::uint16_t tag) noexcept {
    switch (tag) {
      case kWidth:
      case kHeight:
      case kBits:
      case kCompression:
      case kPhotometric:
      case kDescription:
      case kSamples:
      case kPlanar:
      case kPredictor:
      case kTileWidth:
      case kTileHeight:
      case kTileOffsets:
      case kTileSizes:
      case kSubdirectories:
      case kSampleFormat:
      case kJpegTables: return true;
      default: return false;
    }
  }

  Result<Ok> store(const Entry& entry) {
    switch (entry.tag) {
      case kWidth: return number(entry, directory_.width);
      case kHeight: return number(entry, directory_.height);
      case kBits: return same(entry, directory_.bits);
      case kCompression: return number(entry, directory_.compression);
      case kPhotometric: return number(entry, directory_.photometric);
      case kDescription: return text(entry);
      case kSamples: return number(entry, directory_.samples);
      case kPlanar: return number(entry, directory_.planar);
      case kPredictor: return number(entry, directory_.predictor);
      case kTileWidth: return number(entry, directory_.tile_width);
      case kTileHeight: return number(entry, directory_.tile_height);
      case kTileOffsets: return table(entry, directory_.tile_offsets);
      case kTileSizes: return table(entry, directory_.tile_sizes);
      case kSubdirectories: return numbers(entry, kMostSubdirectories, directory_.subdirectories);
      case kSampleFormat: return same(entry, directory_.sample_format);
      case kJpegTables: return block(entry, directory_.jpeg_tables);
      default: return Ok{};
    }
  }

  Result<Ok> number(const Entry& entry, std::uint64_t& to) {
    if (entry.values.count != 1 || entry.values.value_size == 1)
      return malformed(directory_.offset, fmt::format("field {} is not one number", entry.tag));
    const auto value = readValue(file_, entry.values, 0);
    if (!value) return value.error();
    to = *value;
    return Ok{};
  }

  Result<Ok> numbers(const Entry& entry, std::uint64_t most, std::vector<std::uint64_t>& to) {
    if (entry.values.count > most || entry.values.value_size == 1) {
      return malformed(directory_.offset,
                       fmt::format("field {} has {} values; up to {} are supported", entry.tag,
                                   entry.values.count, most));
    }
    to.clear();
    for (std::uint64_t i = 0; i < entry.values.count; ++i) {
      const auto value = readValue(file_, entry.values, i);
      if (!value) return value.error();
      to.push_back(*value);
    }
    return Ok{};
  }

  // Takes a field with one number for each sample; these must be equal.
  Result<Ok> same(const Entry& entry, std::uint64_t& to) {
    std::vector<std::uint64_t> all;
    if (const auto got = numbers(entry, kMostSamples, all); !got) return got;
    const bool equal = !all.empty() && std::equal(all.begin() + 1, all.end(), all.begin());
    to = equal ? all.front() : 0;
    return Ok{};
  }

  Result<Ok> block(const Entry& entry, std::vector<std::uint8_t>& to) {
    if (entry.values.count > kMostText || entry.values.value_size != 1) {
      return malformed(directory_.offset,
                       fmt::format("field {} has {} bytes; up to {} are supported", entry.tag,
                                   entry.values.count, kMostText));
    }
    to.resize(entry.values.count);
    return file_.read(entry.values.offset, to);
  }

  // Takes a description; one that is longer than kMostText is not needed and is left out.
  Result<Ok> text(const Entry& entry) {
    std::vector<std::uint8_t> bytes;
    if (entry.values.count > kMostText) return Ok{};
    if (const auto got = block(entry, bytes); !got) return got;
    directory_.description.assign(bytes.begin(), std::find(bytes.begin(), bytes.end(), 0));
    return Ok{};
  }

  Result<Ok> table(const Entry& entry, TiffTable& to) {
    if (entry.values.value_size == 1)
      return malformed(directory_.offset,
                       fmt::format("field {} has values of one byte", entry.tag));
    to = entry.values;
    return Ok{};
  }

  const RandomAccess& file_;
  TiffDirectory directory_;
};

}  // namespace

Result<std::uint64_t> firstDirectory(const RandomAccess& file) {
  std::array<std::uint8_t, 16> head{};
  const std::span<std::uint8_t> there(head.data(),
                                      std::min<std::uint64_t>(file.size(), head.size()));
  if (const auto got = file.read(0, there); !got) return got.error();
  constexpr std::array<std::uint8_t, 8> kBig = {'I', 'I', 43, 0, 8, 0, 0, 0};
  const bool tiff =
      std::memcmp(head.data(), "II", 2) == 0 || std::memcmp(head.data(), "MM", 2) == 0;
  if (!tiff || (head[2] + head[3] != 42 && head[2] + head[3] != 43))
    return Error{Errc::kUnsupported, "is not a TIFF file"};
  if (std::memcmp(head.data(), kBig.data(), kBig.size()) != 0) {
    return Error{Errc::kUnsupported,
                 "is a TIFF file, but not a BigTIFF in little-endian order, the only form read"};
  }
  if (there.size() < head.size()) return Error{Errc::kMalformed, "ends within its first 16 bytes"};
  return little(&head[8], 8);
}

Result<TiffDirectory> readDirectory(const RandomAccess& file, std::uint64_t offset) {
  return Reader(file, offset).read();
}

Result<std::uint64_t> readValue(const RandomAccess& file, const TiffTable& table,
                                std::uint64_t index) {
  std::array<std::uint8_t, 8> bytes{};
  const auto size = static_cast<std::size_t>(table.value_size);
  const auto got = file.read(table.offset + index * size, std::span(bytes).first(size));
  if (!got) return got.error();
  return little(bytes.data(), table.value_size);
}

}  // namespace merlin::render::image
