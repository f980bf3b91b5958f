#include "render/mesh/io/gzip.h"

#include <algorithm>
#include <limits>
#include <new>

#include <fmt/format.h>
#include <zlib.h>

namespace merlin::render::mesh {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;  // [bytes] that are unpacked at once

// Unpacks block by block. A file may be several packed ones, one after another.
class Gunzip {
 public:
  explicit Gunzip(std::string_view bytes) : size_(bytes.size()), left_(bytes) {
    constexpr int kGzipOnly = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~Gunzip() { inflateEnd(&stream_); }
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  // Appends up to a block. Returns why that failed; an empty text if it did not.
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
  // Gives zlib more bytes, in portions, since zlib counts in 32 bits.
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
  std::size_t size_;       // of all that is packed [bytes]
  std::string_view left_;  // not given to zlib yet
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
