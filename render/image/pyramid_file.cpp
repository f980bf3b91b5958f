#include "render/image/pyramid_file.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

namespace merlin::render::image {
namespace {

constexpr std::size_t kMostLevels = 32;
constexpr std::string_view kWayOut = "make a new one: merlin image import IN -o OUT.tif";

constexpr std::uint64_t kJpeg = 7, kDeflate = 8, kOldDeflate = 32946;
constexpr std::uint64_t kGrey = 1, kRgb = 2, kYCbCr = 6;

std::int64_t tilesIn(std::int64_t pixels, std::int64_t side) { return (pixels + side - 1) / side; }

bool isHalf(std::uint64_t part, std::uint64_t whole) {
  return part == std::max<std::uint64_t>(whole / 2, 1) || part == whole / 2 + whole % 2;
}

// Returns why the form of a directory's pixels is not supported; empty if it is.
std::string unsupported(const TiffDirectory& d) {
  if (d.tile_offsets.value_size == 0 || d.tile_sizes.value_size == 0 || d.tile_width == 0)
    return "is not tiled";
  if (d.tile_width != d.tile_height || (d.tile_width != 256 && d.tile_width != 512)) {
    return fmt::format("has tiles of {} x {} pixels; 256 x 256 and 512 x 512 are supported",
                       d.tile_width, d.tile_height);
  }
  const bool jpeg = d.compression == kJpeg;
  if (!jpeg && d.compression != kDeflate && d.compression != kOldDeflate)
    return fmt::format("has compression {}; JPEG (7) and deflate (8) are supported", d.compression);
  const std::uint64_t channels = d.photometric == kGrey ? 1 : 3;
  const bool colours =
      d.photometric == kGrey || d.photometric == kRgb || (jpeg && d.photometric == kYCbCr);
  const bool samples = d.samples == channels || (!jpeg && channels == 3 && d.samples == 4);
  if (!colours || !samples || d.bits != 8 || d.sample_format != 1 || d.planar != 1) {
    return fmt::format(
        "has {} samples of {} bits a pixel in colour space {}; grey and RGB of 8 bits are "
        "supported",
        d.samples, d.bits, d.photometric);
  }
  if (d.predictor != 1 && (jpeg || d.predictor != 2))
    return fmt::format("has predictor {}; 1 and 2 are supported", d.predictor);
  return {};
}

TileForm formOf(const TiffDirectory& d) {
  return {d.compression == kJpeg ? TileCoding::kJpeg : TileCoding::kDeflate,
          static_cast<int>(d.tile_width),
          static_cast<int>(d.samples),
          d.predictor == 2,
          {}};
}

}  // namespace

Result<std::shared_ptr<const PyramidFile>> PyramidFile::open(const std::string& path) {
  return ofFile(FileAccess::open(path), path);
}

Result<std::shared_ptr<const PyramidFile>> PyramidFile::open(UniqueFd file,
                                                             const std::string& name) {
  return ofFile(FileAccess::of(std::move(file), name), name);
}

Result<std::shared_ptr<const PyramidFile>> PyramidFile::ofFile(
    Result<std::unique_ptr<FileAccess>> file, const std::string& name) {
  if (!file) return file.error();
  const FileStamp stamp = (*file)->stamp();
  auto read = PyramidFile::read(*std::move(file), name);
  if (read) std::const_pointer_cast<PyramidFile>(*read)->stamp_ = stamp;
  return read;
}

// A shared_ptr, since either the reader's thread or the wall's may be the last to use the file.
Result<std::shared_ptr<const PyramidFile>> PyramidFile::read(
    std::unique_ptr<const RandomAccess> file, const std::string& name) {
  const std::shared_ptr<PyramidFile> pyramid(new PyramidFile);
  pyramid->file_ = std::move(file);
  pyramid->name_ = name;
  if (const auto read = pyramid->readLevels(); !read) return read.error();
  return std::shared_ptr<const PyramidFile>(pyramid);
}

std::shared_ptr<const PyramidFile> PyramidFile::ofOnePixel() {
  const std::shared_ptr<PyramidFile> pyramid(new PyramidFile);
  pyramid->levels_.push_back({1, 1, 1, 1});
  return pyramid;
}

Error PyramidFile::levelError(std::size_t level, const std::string& what) const {
  return {Errc::kMalformed, fmt::format("{}: level {}: {}; {}", name_, level, what, kWayOut)};
}

Result<Ok> PyramidFile::readLevels() {
  const auto named = [&](const Error& e) {
    return Error{e.code, fmt::format("{}: {}; {}", name_, e.what, kWayOut)};
  };
  const auto all = directories();
  if (!all) return named(all.error());
  for (const TiffDirectory& directory : *all) {
    if (const auto added = addLevel(directory); !added) return added;
  }
  const PyramidLevel& last = levels_.back();
  if (last.columns * last.rows > kMostCoarsest) {
    return levelError(
        levels_.size() - 1,
        fmt::format("is the coarsest, and has {} x {} pixels; a pyramid goes on until a "
                    "level has at most {} tiles of {} x {}",
                    last.width, last.height, kMostCoarsest, kTileSide, kTileSide));
  }
  panorama_ = all->front().description.find(kPanoramaMark) != std::string::npos;
  return Ok{};
}

// Returns the directories of all levels: the first one, then its subdirectories or those that
// follow it. Each must be about half as large as the previous one, which also ends a loop of
// directories.
Result<std::vector<TiffDirectory>> PyramidFile::directories() const {
  const auto first = firstDirectory(*file_);
  if (!first) return first.error();
  std::vector<TiffDirectory> all;
  std::vector<std::uint64_t> subs;
  for (std::uint64_t offset = *first; offset != 0 && all.size() < kMostLevels;) {
    auto directory = readDirectory(*file_, offset);
    if (!directory) return directory.error();
    if (all.empty()) subs = directory->subdirectories;
    if (!all.empty() && (!isHalf(directory->width, all.back().width) ||
                         !isHalf(directory->height, all.back().height))) {
      return Error{Errc::kMalformed,
                   fmt::format("level {}, the directory at byte {}, has {} x {} pixels, which is "
                               "not half of {} x {}",
                               all.size(), offset, directory->width, directory->height,
                               all.back().width, all.back().height)};
    }
    const bool smallest = directory->width <= 1 && directory->height <= 1;
    all.push_back(*std::move(directory));
    offset = all.size() <= subs.size() ? subs[all.size() - 1] : 0;
    if (subs.empty()) offset = all.back().next;
    if (smallest && offset != 0)
      return Error{Errc::kMalformed,
                   "has a level below one of a single pixel: the directories loop"};
  }
  return all;
}

Result<Ok> PyramidFile::addLevel(const TiffDirectory& d) {
  const std::size_t level = levels_.size();
  if (d.width < 1 || d.height < 1 || d.width > kMostSide || d.height > kMostSide) {
    return levelError(
        level, fmt::format("has {} x {} pixels; 1 to {} are supported in each direction", d.width,
                           d.height, kMostSide));
  }
  if (const std::string why = unsupported(d); !why.empty())
    return Error{Errc::kUnsupported,
                 fmt::format("{}: level {}: {}; {}", name_, level, why, kWayOut)};
  const TileForm form = formOf(d);
  if (level == 0) form_ = form;
  if (form.side != form_.side || form.coding != form_.coding || form.samples != form_.samples ||
      form.differences != form_.differences)
    return levelError(level, "has tiles of another form than level 0");
  const auto width = static_cast<std::int64_t>(d.width),
             height = static_cast<std::int64_t>(d.height);
  const std::int64_t columns = tilesIn(width, form.side), rows = tilesIn(height, form.side);
  const auto tiles = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
  if (d.tile_offsets.count != tiles || d.tile_sizes.count != tiles) {
    return levelError(
        level, fmt::format("has {} x {} pixels, which are {} tiles, and lists the places of {} "
                           "and the sizes of {}",
                           width, height, tiles, d.tile_offsets.count, d.tile_sizes.count));
  }
  levels_.push_back({width, height, tilesIn(width, kTileSide), tilesIn(height, kTileSide)});
  tables_.push_back({d.tile_offsets, d.tile_sizes, d.jpeg_tables, columns});
  return Ok{};
}

PyramidReader::PyramidReader(std::shared_ptr<const PyramidFile> file)
    : file_(std::move(file)), form_(file_->form_), decoder_(form_), own_(4 * form_.pixelBytes()) {}

// Reads the file's own tile into own_.
Result<Ok> PyramidReader::readOwn(int level, std::int64_t column, std::int64_t row) {
  if (std::exchange(own_level_, -1) == level && own_column_ == column && own_row_ == row) {
    own_level_ = level;
    return Ok{};
  }
  const PyramidFile::Tables& tables = file_->tables_[static_cast<std::size_t>(level)];
  const auto index = static_cast<std::uint64_t>(row * tables.columns + column);
  const auto offset = readValue(*file_->file_, tables.offsets, index);
  if (!offset) return offset.error();
  const auto size = readValue(*file_->file_, tables.sizes, index);
  if (!size) return size.error();
  if (*size == 0) {
    for (std::size_t i = 0; i < own_.size(); ++i) own_[i] = i % 4 == 3 ? 255 : 0;
  } else {
    if (*size > form_.mostBytes()) {
      return Error{Errc::kMalformed,
                   fmt::format("has {} bytes; up to {} are supported", *size, form_.mostBytes())};
    }
    const std::uint64_t room = file_->file_->size();
    if (*size > room || *offset > room - *size) {
      return Error{Errc::kMalformed, fmt::format("its {} bytes at byte {} end beyond the file's {}",
                                                 *size, *offset, room)};
    }
    bytes_.resize(*size);
    if (const auto read = file_->file_->read(*offset, bytes_); !read) return read;
    form_.jpeg_tables = tables.jpeg_tables;
    if (const auto decoded = decoder_.decode(bytes_, own_); !decoded) return decoded;
  }
  own_level_ = level;
  own_column_ = column;
  own_row_ = row;
  return Ok{};
}

Result<Ok> PyramidReader::readTile(const TilePlace& place, std::span<std::uint8_t> rgba) {
  assert(rgba.size() == kTileBytes && place.level >= 0 &&
         static_cast<std::size_t>(place.level) < file_->levels_.size());
  const int per_side = form_.side / kTileSide;
  const auto read = readOwn(place.level, place.column / per_side, place.row / per_side);
  if (!read) {
    return Error{read.error().code,
                 fmt::format("{}: level {}, tile {} of row {}: {}", file_->name_, place.level,
                             place.column / per_side, place.row / per_side, read.error().what)};
  }
  const auto side = static_cast<std::size_t>(form_.side);
  const auto left = static_cast<std::size_t>(place.column % per_side) * kTileSide;
  const auto top = static_cast<std::size_t>(place.row % per_side) * kTileSide;
  constexpr std::size_t kRow = std::size_t{4} * kTileSide;
  for (std::size_t y = 0; y < kTileSide; ++y)
    std::copy_n(&own_[4 * ((top + y) * side + left)], kRow, &rgba[y * kRow]);
  repeatEdges(place, rgba);
  return Ok{};
}

void PyramidReader::repeatEdges(const TilePlace& place, std::span<std::uint8_t> rgba) const {
  const PyramidLevel& level = file_->levels_[static_cast<std::size_t>(place.level)];
  const auto there = [](std::int64_t whole, std::int32_t tile) {
    const std::int64_t pixels = whole - std::int64_t{tile} * kTileSide;
    return static_cast<std::size_t>(std::clamp<std::int64_t>(pixels, 1, kTileSide));
  };
  const std::size_t width = there(level.width, place.column),
                    height = there(level.height, place.row);
  constexpr std::size_t kRow = std::size_t{4} * kTileSide;
  for (std::size_t y = 0; width < kTileSide && y < height; ++y) {
    std::uint8_t* const row = &rgba[y * kRow];
    for (std::size_t x = width; x < kTileSide; ++x)
      std::copy_n(row + 4 * (width - 1), 4, row + 4 * x);
  }
  for (std::size_t y = height; y < kTileSide; ++y)
    std::copy_n(&rgba[(height - 1) * kRow], kRow, &rgba[y * kRow]);
}

}  // namespace merlin::render::image
