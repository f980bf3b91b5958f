#include "render/mesh/io/gzip.h"

#include <algorithm>
#include <limits>
#include <new>

#include <fmt/format.h>
#include <zlib.h>

namespace merlin::render::mesh {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;  // number of bytes unpacked at a time

// Unpacks a gzip file block by block. The file may consist of several packed members, one after
// another.
class Gunzip {
 public:
  explicit Gunzip(std::string_view bytes) : size_(bytes.size()), left_(bytes) {
    constexpr int kGzipOnly = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Gunzip() { inflateEnd(&stream_); }
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  // Unpacks up to kBlock bytes and appends them to `text`. Returns an error message, or an empty
  // text on success.
  std::string appendTo(std::string& text) {
    feed();
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    stream_.next_out = reinterpret_cast<Bytef*>(text.data() + before);
    stream_.avail_out = kBlock;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    text.resize(before + kBlock - stream_.avail_out);
    if (status == Z_STREAM_END) return next();
    if (status == Z_OK && (text.size() > before || stream_.avail_in > 0 || !left_.empty()))
      return {};
    if (status == Z_OK || status == Z_BUF_ERROR) return "is cut";
    return fmt::format("is damaged at byte {} of {}: {}", size_ - left_.size() - stream_.avail_in,
                       size_, stream_.msg ? stream_.msg : "zlib gives no reason");
  }

  bool ended() const noexcept { return ended_; }

 private:
  // Passes more input to zlib if it has none left; in portions, since zlib counts in 32 bits.
  void feed() {
    if (stream_.avail_in > 0) return;
    const std::size_t n = std::min<std::size_t>(left_.size(), std::numeric_limits<uInt>::max());
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(left_.data()));
    stream_.avail_in = static_cast<uInt>(n);
    left_.remove_prefix(n);
  }

  std::string next() {
    feed();
    const std::string_view rest(reinterpret_cast<const char*>(stream_.next_in), stream_.avail_in);
    ended_ = !isGzip(rest);
    if (!ended_) inflateReset(&stream_);
    return {};
  }

  z_stream stream_{};
  std::size_t size_;       // size of the packed input [bytes]
  std::string_view left_;  // input that was not passed to zlib yet
  bool ended_ = false;
};

}  // namespace

bool isGzip(std::string_view bytes) noexcept { return bytes.starts_with("\x1F\x8B"); }

std::string gunzipBeginning(std::string_view bytes, std::size_t most) {
  std::string text;
  Gunzip unpacking(bytes);
  while (text.size() < most && !unpacking.ended()) {
    if (!unpacking.appendTo(text).empty()) break;
  }
  text.resize(std::min(text.size(), most));
  return text;
}

Result<std::string> gunzip(std::string_view bytes, std::size_t most) {
  std::string text;
  Gunzip unpacking(bytes);
  while (!unpacking.ended()) {
    const std::string fault = unpacking.appendTo(text);
    if (!fault.empty()) return Error{Errc::kMalformed, "gzip: " + fault};
    if (text.size() > most)
      return Error{Errc::kUnsupported, fmt::format("gzip: unpacks to more than {} bytes", most)};
  }
  return text;
}

Error packedFileError(std::string_view bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  std::string block;
  Gunzip unpacking(bytes);
  for (std::size_t done = 0; done < kMost && !unpacking.ended(); done += block.size()) {
    block.clear();
    const std::string fault = unpacking.appendTo(block);
    if (!fault.empty()) return {Errc::kMalformed, "gzip: " + fault};
  }
  return {Errc::kUnsupported,
          "is packed by gzip; of packed files only Inventor and VRML are read: gunzip -c IN > OUT "
          "unpacks it"};
}

}  // namespace merlin::render::mesh
