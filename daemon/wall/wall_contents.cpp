#include "daemon/wall/wall_contents.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/open_below.h"
#include "daemon/base/printable_text.h"
#include "render/content/shown_colours.h"
#include "render/lod/io/mrm_file.h"

namespace merlin::wall {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSlides = 10'000;
constexpr std::string_view kModelEnding = ".mrm";
constexpr std::string_view kPyramidEndings[] = {".tif", ".tiff"};

bool isPyramid(const std::string& path) {
  return std::ranges::any_of(kPyramidEndings, [&](auto ending) { return path.ends_with(ending); });
}

ContentEntry entryOf(const ContentSettings& c, const std::string& pointer) {
  ContentEntry entry{pointer + "/model", c.name, c.model, ContentKind::kModel, c.show_as};
  if (!c.picture.empty()) {
    entry = {pointer + "/picture", c.name, c.picture, ContentKind::kPicture, c.show_as};
  } else if (!c.slides.empty()) {
    entry = {pointer + "/slides", c.name, c.slides, ContentKind::kSlides, c.show_as};
  }
  if (entry.name.empty()) entry.name = nameOf(entry.path);
  return entry;
}

// Returns `path` relative to the content folder `entry.below`.
std::string_view nameBelow(const ContentEntry& entry, std::string_view path) {
  path.remove_prefix(std::min(entry.below.size() + 1, path.size()));
  return path;
}

Result<render::lod::Dendrogram> readModelCopy(const ContentEntry& entry, FileStamp& stamp) {
  if (entry.below.empty()) return render::lod::readMrmCopy(entry.path, &stamp);
  const auto file = openBelow(entry.below, nameBelow(entry, entry.path));
  if (!file) return file.error();
  return render::lod::readMrmCopy(file->get(), entry.path, &stamp);
}

Result<std::shared_ptr<const render::image::PyramidFile>> openPyramid(const ContentEntry& entry,
                                                                      const std::string& path) {
  if (entry.below.empty()) return render::image::PyramidFile::open(path);
  auto file = openBelow(entry.below, nameBelow(entry, path));
  if (!file) return file.error();
  return render::image::PyramidFile::open(*std::move(file), path);
}

Result<WallContent> readModel(const ContentEntry& entry,
                              const render::content::ShownFeature& show) {
  FileStamp stamp;
  auto model = readModelCopy(entry, stamp);
  if (!model) return model.error();
  if (const auto shown = render::content::checkShown(*model, show); !shown)
    return Error{Errc::kInvalidArgument, fmt::format("{}: {}", entry.path, shown.error().what)};
  return WallContent{entry, entry.path, stamp, *std::move(model)};
}

Result<WallContent> readPicture(const ContentEntry& entry, const std::string& file) {
  auto pyramid = openPyramid(entry, file);
  if (!pyramid) return pyramid.error();
  auto picture = render::content::makePicture(*std::move(pyramid), entry.show_as);
  if (!picture) return picture.error();
  const FileStamp stamp = (*picture)->file->stamp();
  return WallContent{entry, file, stamp, *std::move(picture)};
}

// Whether this is a picture in a common format, which people may put into a folder of slides by
// mistake. `merlin image import` converts these formats, among others, to pyramids.
bool isOrdinaryPicture(const std::string& name) {
  constexpr std::string_view kEndings[] = {".jpg", ".jpeg", ".png", ".webp", ".bmp", ".gif"};
  std::string ending = fs::path(name).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return std::ranges::find(kEndings, ending) != std::end(kEndings);
}

// Names of the files in a folder of slides, each list sorted by name.
struct FilesOfSlides {
  std::vector<std::string> pyramids, pictures;
};

Result<FilesOfSlides> slidesIn(const ContentEntry& entry) {
  const std::string& folder = entry.path;
  FilesOfSlides files;
  std::error_code error;
  UniqueFd opened;  // keeps the folder open, so that nobody can replace it by a link
  if (!entry.below.empty()) {
    auto found = openFolderBelow(entry.below, nameBelow(entry, folder));
    if (!found) return found.error();
    opened = *std::move(found);
  }
  const std::string listed =
      opened.valid() ? fmt::format("/proc/self/fd/{}", opened.get()) : folder;
  for (fs::directory_iterator it(listed, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(".")) continue;
    if (isPyramid(name) && files.pyramids.size() < kMostSlides) files.pyramids.push_back(name);
    if (isOrdinaryPicture(name) && files.pictures.size() < kMostSlides)
      files.pictures.push_back(name);
  }
  if (error) {
    const bool missing = error == std::errc::no_such_file_or_directory;
    return Error{missing ? Errc::kNotFound : Errc::kIo,
                 fmt::format("{}: {}", folder, error.message())};
  }
  if (files.pyramids.empty()) {
    return Error{Errc::kNotFound,
                 fmt::format("{}: has no pyramid (.tif); make one: merlin image import IN -o "
                             "{}/NAME.tif",
                             folder, folder)};
  }
  std::ranges::sort(files.pyramids);
  std::ranges::sort(files.pictures);
  return files;
}

// Returns a message about the pictures in a folder of slides that are not shown because they are no
// pyramids; empty if there are none.
std::string leftOut(const std::string& folder, const std::vector<std::string>& pictures) {
  if (pictures.empty()) return "";
  constexpr std::size_t kMostNamed = 3;
  const std::string& first = pictures.front();
  const std::string pyramid = fs::path(first).replace_extension(".tif").string();
  std::string names = excerpt(first);
  for (std::size_t i = 1; i < std::min(pictures.size(), kMostNamed); ++i)
    names += ", " + excerpt(pictures[i]);
  if (pictures.size() > kMostNamed)
    names += fmt::format(" and {} more", pictures.size() - kMostNamed);
  const char* const are = pictures.size() == 1 ? "is no pyramid, so it is not shown"
                                               : "are no pyramids, so they are not shown";
  return fmt::format("{}: {} {}: merlin image import {} -o {} makes one", folder, names, are,
                     excerpt(first), excerpt(pyramid));
}

// Reads the first of these slides that can be shown; nothing if there is none. Adds a sentence
// about each slide before it to `skipped`.
std::optional<WallContent> firstOf(const std::vector<std::string>& names, const ContentEntry& entry,
                                   std::vector<std::string>& skipped) {
  for (const std::string& name : names) {
    auto read = readPicture(entry, (fs::path(entry.path) / name).string());
    if (read) return *std::move(read);
    skipped.push_back(fmt::format("a slide is left out: {}", read.error().what));
  }
  return std::nullopt;
}

// The slides in the order in which they follow the current one, cyclically. `ahead`: those after
// the current one, to the end of the list. `around`: those from the beginning of the list to the
// current one, inclusive.
struct Way {
  std::vector<std::string> ahead, around;
};

Way wayFrom(std::vector<std::string> slides, const std::string& name, bool back) {
  if (back) std::ranges::reverse(slides);
  const auto passed = [&](const std::string& s) { return back ? s >= name : s <= name; };
  const auto ahead = name.empty() ? slides.begin() : std::ranges::find_if_not(slides, passed);
  return {{ahead, slides.end()}, {slides.begin(), ahead}};
}

// Whether none of the slides `ahead` can be shown. If so, adds a sentence about each of them to
// `skipped`, since they are never tried otherwise.
bool isEnd(const std::vector<std::string>& ahead, const ContentEntry& entry,
           std::vector<std::string>& skipped) {
  std::vector<std::string> behind_it;
  if (firstOf(ahead, entry, behind_it)) return false;
  std::ranges::move(behind_it, std::back_inserter(skipped));
  return true;
}

// Reads a slide. is_last_slide means the last slide that can be shown: otherwise a damaged file at
// the end of the list would prevent the change to the next content. The same holds for
// is_first_slide.
Result<WallContent> readSlide(const ContentEntry& entry, const SlideTurn& turn,
                              std::vector<std::string>& skipped) {
  const auto files = slidesIn(entry);
  if (!files) return files.error();
  const std::vector<std::string>& slides = files->pyramids;
  const Way way = wayFrom(slides, fs::path(turn.from).filename().string(), turn.back);
  auto read = firstOf(way.ahead, entry, skipped);
  if (!read) read = firstOf(way.around, entry, skipped);
  if (!read) {
    return Error{Errc::kNotFound, fmt::format("{}: none of its {} pyramids can be shown: {}",
                                              entry.path, slides.size(), skipped.back())};
  }
  const std::string name = fs::path(read->file).filename().string();
  std::vector<std::string> passed;  // slides in the other direction, which were reported before
  read->is_last_slide =
      isEnd(wayFrom(slides, name, false).ahead, entry, turn.back ? passed : skipped);
  read->is_first_slide =
      isEnd(wayFrom(slides, name, true).ahead, entry, turn.back ? skipped : passed);
  read->left_out = leftOut(entry.path, files->pictures);
  return *std::move(read);
}

}  // namespace

std::vector<ContentEntry> contentsOf(const WallSettings& wall) {
  std::vector<ContentEntry> contents;
  if (!wall.model.empty() || wall.contents.empty()) {
    contents.push_back({"/wall/model", nameOf(wall.model), wall.model, ContentKind::kModel, {}});
  }
  for (std::size_t i = 0; i < wall.contents.size(); ++i)
    contents.push_back(entryOf(wall.contents[i], fmt::format("/wall/contents/{}", i)));
  return contents;
}

std::string namesOf(const std::vector<ContentEntry>& contents) {
  std::vector<std::string_view> names;
  for (const ContentEntry& entry : contents) names.push_back(entry.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string nameOf(const std::string& path) {
  const fs::path file(path);
  return (file.has_filename() ? file : file.parent_path()).stem().string();
}

std::optional<ContentKind> kindByEnding(const std::string& name) {
  if (name.ends_with(kModelEnding)) return ContentKind::kModel;
  return isPyramid(name) ? std::optional(ContentKind::kPicture) : std::nullopt;
}

std::vector<std::size_t> placesOf(const std::vector<ContentEntry>& contents,
                                  const std::vector<std::string>& names) {
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(contents, name, &ContentEntry::name);
    if (found != contents.end())
      places.push_back(static_cast<std::size_t>(found - contents.begin()));
  }
  return places;
}

Result<ContentEntry> contentBelow(const std::string& folder, const std::string& name) {
  const std::string path = fmt::format("{}/{}", folder, name);
  ContentEntry entry{"", nameOf(path), path, ContentKind::kPicture, {}, folder};
  if (openFolderBelow(folder, name)) {
    entry.kind = ContentKind::kSlides;
    return entry;
  }
  if (const auto file = openBelow(folder, name); !file) return file.error();
  const auto kind = kindByEnding(path);
  if (!kind) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{}: is neither a model (.mrm), a pyramid (.tif) nor a folder of "
                             "pyramids; `merlin show FILE` makes one of a file",
                             path)};
  }
  entry.kind = *kind;
  return entry;
}

WallContent missingContent(const ContentEntry& entry, std::string fault,
                           const std::optional<FileStamp>& tried) {
  WallContent missing{entry, entry.path, {}, render::content::noPicture()};
  missing.stamp = tried.value_or(FileStamp{});
  missing.fault = std::move(fault);
  return missing;
}

Result<WallContent> readContent(const ContentEntry& entry,
                                const render::content::ShownFeature& show, const SlideTurn& turn,
                                std::vector<std::string>& skipped) {
  switch (entry.kind) {
    case ContentKind::kModel: return readModel(entry, show);
    case ContentKind::kPicture: return readPicture(entry, entry.path);
    case ContentKind::kSlides: return readSlide(entry, turn, skipped);
  }
  return Error{Errc::kUnsupported, entry.path};
}

}  // namespace merlin::wall
