#include "render/image/png_writer.h"

#include <cassert>
#include <csetjmp>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "daemon/base/files.h"

namespace merlin::render::image {
namespace {

// Textures are compressed fast: they may have 64 million pixels, and somebody waits for them.
constexpr int kUsualCompression = 6, kFastCompression = 3;

struct PngRows {
  int width = 0, height = 0;
  bool alpha = false;  // a fourth byte for each pixel, which is not written
  int compression = kUsualCompression;
  std::vector<std::uint8_t*> rows{};
};

// Returns pointers to the rows. libpng declares them as mutable, but does not write to them.
PngRows rowsOf(int width, int height, std::span<const std::uint8_t> pixels, bool alpha) {
  PngRows image{width, height, alpha, alpha ? kUsualCompression : kFastCompression};
  const std::size_t stride = (alpha ? std::size_t{4} : 3) * static_cast<std::size_t>(width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    image.rows.push_back(const_cast<std::uint8_t*>(pixels.data()) + y * stride);
  return image;
}

// Callbacks of libpng; the I/O pointer that it passes is a WriteBytes.
void writeChunk(png_structp png, png_bytep data, png_size_t size) {
  const auto& write = *static_cast<const WriteBytes*>(png_get_io_ptr(png));
  if (!write(std::as_bytes(std::span(data, size)))) png_error(png, "the file cannot be written");
}
void flushNoFile(png_structp) {}
void keepQuietOfWriting(png_structp, png_const_charp) {}

// Since libpng reports errors by longjmp, no C++ object with a destructor is alive here.
bool encode(const WriteBytes* write, const PngRows* image) {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, keepQuietOfWriting);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {  // NOLINT: libpng's way to report
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, const_cast<WriteBytes*>(write), writeChunk, flushNoFile);
  png_set_compression_level(png, image->compression);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image->width),
               static_cast<png_uint_32>(image->height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (image->alpha) png_set_filler(png, 0, PNG_FILLER_AFTER);
  png_write_image(png, const_cast<png_bytepp>(image->rows.data()));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

Result<Ok> writePng(const std::string& path, int width, int height,
                    std::span<const std::uint8_t> pixels) {
  assert(pixels.size() ==
         std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const PngRows image = rowsOf(width, height, pixels, true);
  return writeFile(path, [&](const WriteBytes& write) { return encode(&write, &image); });
}

Result<std::vector<std::uint8_t>> encodePng(int width, int height,
                                            std::span<const std::uint8_t> pixels) {
  if (width < 1 || height < 1 ||
      pixels.size() !=
          std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return Error{Errc::kInvalidArgument,
                 fmt::format("PNG: {} bytes for {} x {} pixels", pixels.size(), width, height)};
  const PngRows image = rowsOf(width, height, pixels, false);
  std::vector<std::uint8_t> file;
  const WriteBytes append = [&](std::span<const std::byte> bytes) {
    const auto* const from = reinterpret_cast<const std::uint8_t*>(bytes.data());
    file.insert(file.end(), from, from + bytes.size());
    return true;
  };
  if (!encode(&append, &image)) return Error{Errc::kIo, "PNG: there is no memory for it"};
  return file;
}

}  // namespace merlin::render::image
