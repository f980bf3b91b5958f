#include "daemon/page/thumbnail_files.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/page/thumbnails.h"
#include "render/image/image_file.h"

namespace merlin::page {
namespace {

constexpr std::size_t kMostFileBytes = 512 << 10;
constexpr std::string_view kEnding = ".jpg";

// FNV-1a, 64 bits. Source: draft-eastlake-fnv.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100'0000'01B3;
  return hash;
}

}  // namespace

std::string ThumbnailFiles::fileName(const std::string& key) const {
  return fmt::format("{}{:016x}{}", prefix_, hashOf(key), kEnding);
}

std::optional<std::string> ThumbnailFiles::read(const std::string& key) const {
  const auto file = FileCopy::read(folder_ + "/" + fileName(key), kMostFileBytes + 1);
  if (!file || file->bytes().size() > kMostFileBytes) return std::nullopt;
  const std::string_view bytes = file->text();
  const auto image = render::image::decodeImage(
      {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  const bool fits = bytes.starts_with("\xFF\xD8") && image &&
                    image->width <= Thumbnails::kMostWidth &&
                    image->height <= Thumbnails::kMostHeight;
  return fits ? std::optional(std::string(bytes)) : std::nullopt;
}

Result<Ok> ThumbnailFiles::write(const std::string& key, const std::string& jpeg) const {
  return writeFile(folder_ + "/" + fileName(key), jpeg);
}

void ThumbnailFiles::removeOthers(const std::vector<std::string>& keys) const {
  std::set<std::string> kept;
  for (const std::string& key : keys) kept.insert(fileName(key));
  std::vector<std::filesystem::path> others;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder_, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    const bool ours = name.starts_with(prefix_) && name.size() == fileName("").size();
    if (ours && name.ends_with(kEnding) && !kept.contains(name)) others.push_back(it->path());
  }
  for (const auto& path : others) std::filesystem::remove(path, error);
}

}  // namespace merlin::page
