#include "render/image/png_levels.h"

#include <bit>
#include <cassert>
#include <csetjmp>
#include <cstring>

#include <fmt/format.h>
#include <png.h>

namespace merlin::render::image {
namespace {

constexpr png_uint_32 kMostSide = 1 << 16;
constexpr std::size_t kMostMessage = 128;
constexpr png_alloc_size_t kMostChunk = 1 << 20;  // largest size of a chunk without pixels [bytes]

// The data that libpng's callbacks use while reading. Since libpng reports errors by longjmp, no
// C++ object with a destructor may be alive then, so this struct has none.
struct Reading {
  png_structp png = nullptr;
  png_infop info = nullptr;
  const std::byte* bytes = nullptr;
  std::size_t size = 0, at = 0;
  char message[kMostMessage] = {};
};

void take(png_structp png, png_bytep to, png_size_t count) {
  auto& reading = *static_cast<Reading*>(png_get_io_ptr(png));
  if (count > reading.size - reading.at) png_error(png, "the file is cut off");
  std::memcpy(to, reading.bytes + reading.at, count);
  reading.at += count;
}

[[noreturn]] void fail(png_structp png, png_const_charp what) {
  auto* reading = static_cast<Reading*>(png_get_error_ptr(png));
  if (reading) std::strncpy(reading->message, what, kMostMessage - 1);
  png_longjmp(png, 1);
}
void keepQuiet(png_structp, png_const_charp) {}

// Reads the head, and sets the transformations to three channels of 16 bits.
bool readHead(Reading& r) {
  r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r, fail, keepQuiet);
  r.info = r.png ? png_create_info_struct(r.png) : nullptr;
  if (!r.info || setjmp(png_jmpbuf(r.png))) return false;  // NOLINT: libpng's way to report
  png_set_read_fn(r.png, &r, take);
  png_set_user_limits(r.png, kMostSide, kMostSide);
  png_set_chunk_malloc_max(r.png, kMostChunk);
  png_read_info(r.png, r.info);
  png_set_expand_16(r.png);
  png_set_strip_alpha(r.png);
  png_set_gray_to_rgb(r.png);
  if (std::endian::native == std::endian::little) png_set_swap(r.png);
  png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  return true;
}

bool readRows(Reading& r, png_bytepp rows) {
  if (setjmp(png_jmpbuf(r.png))) return false;  // NOLINT: libpng's way to report
  png_read_image(r.png, rows);
  png_read_end(r.png, nullptr);
  return true;
}

Result<Levels> read(Reading& r, std::size_t most_pixels) {
  const auto broken = [&] { return Error{Errc::kMalformed, fmt::format("PNG: {}", r.message)}; };
  if (!readHead(r)) return broken();
  const std::size_t width = png_get_image_width(r.png, r.info);
  const std::size_t height = png_get_image_height(r.png, r.info);
  if (width > most_pixels / height) {
    return Error{Errc::kUnsupported, fmt::format("{} x {} pixels; the maximum is {} in all", width,
                                                 height, most_pixels)};
  }
  Levels levels{static_cast<int>(width), static_cast<int>(height), 3, {}};
  levels.values.resize(3 * width * height);
  if (png_get_rowbytes(r.png, r.info) != 6 * width) return broken();
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y)
    rows.push_back(reinterpret_cast<png_bytep>(&levels.values[3 * width * y]));
  if (!readRows(r, rows.data())) return broken();
  return levels;
}

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(data), size);
}
void flushNothing(png_structp) {}

bool write(std::string* to, const Levels& levels, png_bytepp rows) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, keepQuiet);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {  // NOLINT: libpng's way to report
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, to, append, flushNothing);
  png_set_IHDR(png, info, static_cast<png_uint_32>(levels.width),
               static_cast<png_uint_32>(levels.height), 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (std::endian::native == std::endian::little) png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

Result<Levels> decodeLevels(std::span<const std::byte> png, std::size_t most_pixels) {
  Reading reading;
  reading.bytes = png.data();
  reading.size = png.size();
  auto levels = read(reading, most_pixels);
  png_destroy_read_struct(&reading.png, &reading.info, nullptr);
  return levels;
}

Result<std::string> encodeLevels(const Levels& levels) {
  const auto width = static_cast<std::size_t>(levels.width);
  assert(levels.channels == 1 &&
         levels.values.size() == width * static_cast<std::size_t>(levels.height));
  std::vector<png_bytep> rows;
  for (std::size_t at = 0; at < levels.values.size(); at += width) {
    // libpng takes rows that it does not write to as mutable.
    rows.push_back(reinterpret_cast<png_bytep>(const_cast<std::uint16_t*>(&levels.values[at])));
  }
  std::string bytes;
  if (!write(&bytes, levels, rows.data())) return Error{Errc::kIo, "PNG: no memory"};
  return bytes;
}

}  // namespace merlin::render::image
