#include "daemon/cli/show/file_kind.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/open_below.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "render/image/pyramid_file.h"
#include "render/lod/io/mrm_layout.h"
#include "render/range/io/image_header.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

bool isPgm(std::string_view content) {
  return content.starts_with("P5") || content.starts_with("P2");
}
bool isFits(std::string_view content) { return content.starts_with("SIMPLE  ="); }
bool isTiffFile(std::string_view content) {
  return content.starts_with("II") || content.starts_with("MM");
}

// Returns whether a comment in the header of a PGM states a geometry. Comments precede the pixels,
// and are parsed in the same way as by readRange().
bool pgmSaysGeometry(std::string_view content) {
  render::range::ImageHeader header;
  constexpr std::size_t kMostHeader = 1 << 20;
  content = content.substr(0, kMostHeader);
  std::size_t at = content.find('\n');
  while (at != std::string_view::npos && content.substr(at + 1).starts_with('#')) {
    const std::size_t end = std::min(content.find('\n', at + 1), content.size());
    std::string_view line = content.substr(at + 2, end - at - 2);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    // A faulty line counts too, so that mesh import reports the fault.
    if (!render::range::applyLine(line, header)) return true;
    at = end < content.size() ? end : std::string_view::npos;
  }
  return header.scanner || header.angles_deg || header.cell || header.camera ||
         !header.beams.empty() || !header.features.empty();
}

// Returns whether the header of a FITS image has a keyword that states a geometry. The header
// consists of cards of 80 characters, which begin with a keyword of 8.
bool fitsSaysGeometry(std::string_view content) {
  constexpr std::string_view kKeys[] = {"GEOMETRY", "ANGLEH  ", "CELLX   "};
  constexpr std::size_t kCard = 80, kMostCards = 4096;
  for (std::size_t card = 0; card < kMostCards && kCard * (card + 1) <= content.size(); ++card) {
    const std::string_view key = content.substr(kCard * card, 8);
    if (key == "END     ") return false;
    if (std::ranges::find(kKeys, key) != std::end(kKeys)) return true;
  }
  return false;
}

// Reads unsigned numbers of a TIFF in its byte order; numbers beyond the end are 0.
class TiffBytes {
 public:
  explicit TiffBytes(std::string_view content)
      : content_(content), little_(content.starts_with("II")) {}

  std::uint64_t number(std::uint64_t at, std::size_t bytes) const {
    if (at > content_.size() || content_.size() - at < bytes) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const std::size_t place = at + (little_ ? bytes - 1 - i : i);
      value = value << 8 | static_cast<std::uint8_t>(content_[place]);
    }
    return value;
  }

 private:
  std::string_view content_;
  bool little_;
};

// Returns whether the TIFF is a map with one value per pixel. Examines the first image file
// directory only.
bool tiffIsMap(std::string_view content) {
  constexpr std::uint64_t kSamples = 277, kGeoKeys = 34735;
  const TiffBytes bytes(content);
  const bool big = bytes.number(2, 2) == 43;
  const std::uint64_t directory = big ? bytes.number(8, 8) : bytes.number(4, 4);
  const std::uint64_t count = bytes.number(directory, big ? 8 : 2);
  const std::uint64_t first = directory + (big ? 8 : 2), size = big ? 20 : 12;
  bool map = false;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, 4096); ++i) {
    const std::uint64_t entry = first + i * size, tag = bytes.number(entry, 2);
    if (tag == kGeoKeys) map = true;
    if (tag == kSamples && bytes.number(entry + (big ? 12 : 8), 2) > 1) return false;
  }
  return map;
}

bool isModel(std::string_view content) {
  return content.starts_with(
      std::string_view(render::lod::mrm::kMagic, sizeof render::lod::mrm::kMagic));
}

}  // namespace

bool saysGeometry(std::string_view content) {
  if (isPgm(content)) return pgmSaysGeometry(content);
  return isFits(content) ? fitsSaysGeometry(content) : isTiffFile(content) && tiffIsMap(content);
}

Result<FileKind> kindOfFile(const std::string& path, bool as_mesh) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return Error{Errc::kNotFound, path + ": does not exist"};
  if (fs::is_directory(status)) return FileKind::kSlides;
  if (!fs::is_regular_file(status))
    return Error{Errc::kMalformed, path + ": is neither a file nor a folder"};
  if (as_mesh) return FileKind::kMesh;
  const auto file = MappedFile::open(path);
  if (!file) return file.error();
  if (path.ends_with(".mrm") || isModel(file->text())) return FileKind::kModel;
  if (render::image::PyramidFile::open(path)) return FileKind::kPyramid;
  const bool either = isPgm(file->text()) || isFits(file->text()) || isTiffFile(file->text());
  if (either) return saysGeometry(file->text()) ? FileKind::kMesh : FileKind::kPicture;
  return inputKindOf(path) ? FileKind::kMesh : FileKind::kPicture;
}

Result<std::string> nameInFolder(const std::string& path, FileKind kind) {
  fs::path file = fs::path(path).lexically_normal();
  if (!file.has_filename()) file = file.parent_path();
  if (kind == FileKind::kSlides && (file == "." || file == "..")) {
    std::error_code error;
    file = fs::canonical(path, error);
  }
  std::string name = kind == FileKind::kSlides ? file.filename().string() : file.stem().string();
  const bool model = kind == FileKind::kModel || kind == FileKind::kMesh;
  if (kind != FileKind::kSlides) name += model ? ".mrm" : ".tif";
  if (isPlainName(name)) return name;
  return Error{
      Errc::kInvalidArgument,
      fmt::format("{}: the wall cannot name it \"{}\"; give it a name of 1 to 190 bytes of "
                  "text without a dot at the beginning",
                  path, excerpt(name))};
}

}  // namespace merlin::cli
