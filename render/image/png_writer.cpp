#include "render/image/png_writer.h"

#include <cassert>
#include <csetjmp>
#include <vector>

#include <png.h>

#include "daemon/base/files.h"

namespace merlin::render::image {
namespace {

constexpr int kCompression = 6;

// Callbacks of libpng; the I/O pointer that it passes is a WriteBytes.
void writeChunk(png_structp png, png_bytep data, png_size_t size) {
  const auto& write = *static_cast<const WriteBytes*>(png_get_io_ptr(png));
  if (!write(std::as_bytes(std::span(data, size)))) png_error(png, "the file takes no more");
}
void flushNothing(png_structp) {}
void keepQuiet(png_structp, png_const_charp) {}

// No C++ object with a destructor is alive across libpng's longjmp.
bool encode(const WriteBytes* write, int width, int height, std::uint8_t* const* rows) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, keepQuiet);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {  // NOLINT: libpng's way to report
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, const_cast<WriteBytes*>(write), writeChunk, flushNothing);
  png_set_compression_level(png, kCompression);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_filler(png, 0, PNG_FILLER_AFTER);
  png_write_image(png, const_cast<png_bytepp>(rows));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

Result<Ok> writePng(const std::string& path, int width, int height,
                    std::span<const std::uint8_t> pixels) {
  assert(pixels.size() ==
         std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<std::uint8_t*> rows;
  for (int y = 0; y < height; ++y) {
    // libpng declares rows as mutable that it does not write to.
    rows.push_back(const_cast<std::uint8_t*>(pixels.data()) + std::ptrdiff_t{4} * y * width);
  }
  return writeFile(
      path, [&](const WriteBytes& write) { return encode(&write, width, height, rows.data()); });
}

}  // namespace merlin::render::image
