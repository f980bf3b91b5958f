// The contents that a wall can show: those of its configuration, and files of its content folder
// (ShownFolder).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/settings.h"
#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "render/content/picture/picture.h"
#include "render/lod/dendrogram.h"

namespace merlin::wall {

enum class ContentKind { kModel, kPicture, kSlides };

// The name and the file of a content; for slides, `path` is a folder.
struct ContentEntry {
  std::string pointer;  // JSON pointer of the setting that names it
  std::string name, path;
  ContentKind kind = ContentKind::kModel;
  render::content::ShowAs show_as = render::content::ShowAs::kAsMarked;  // pictures and slides
  // The content folder, if the file lies there: no link below it is followed. Empty: the
  // configuration names the file, so the operator vouches for it.
  std::string below{};
};

// The configuration's contents in the order in which they are shown: /wall/model if it names one,
// then /wall/contents. An entry that names no file has an empty path.
std::vector<ContentEntry> contentsOf(const WallSettings& wall);

// The names of contents for a message: "left, right".
std::string namesOf(const std::vector<ContentEntry>& contents);

// The default name of a content: that of its file without the ending, or of its folder.
std::string nameOf(const std::string& path);

// The kind of content, model or picture, that a file's ending stands for; nothing for any other
// ending.
std::optional<ContentKind> kindByEnding(const std::string& name);

// Indexes in `contents` of the contents with these names. A name that none of them has is left out.
std::vector<std::size_t> placesOf(const std::vector<ContentEntry>& contents,
                                  const std::vector<std::string>& names);

// The entry for a file in the content folder; the file's ending decides its kind, and a folder
// becomes slides. `name`: of the file, or SLIDES/FILE. Errors: those of openBelow();
// kInvalidArgument (another ending).
Result<ContentEntry> contentBelow(const std::string& folder, const std::string& name);

// A content that was read.
struct WallContent {
  ContentEntry entry;
  std::string file;  // the file that was read: the entry's, or one of its slides
  FileStamp stamp;   // of that file
  std::variant<render::lod::Dendrogram, std::shared_ptr<const render::content::Picture>> data;
  bool is_first_slide = false, is_last_slide = false;
  // For slides: a sentence about the ordinary pictures in their folder, which are not shown. Empty:
  // there are none.
  std::string left_out{};
  // Why there is nothing to show; then `data` is an empty picture, and `stamp` that of the file or
  // folder that was tried, if there was one. Empty: it was read.
  std::string fault{};

  bool isModel() const noexcept { return data.index() == 0; }
};

// Returns what stands for a content that could not be read, until it can be. `tried`: its
// fileOrFolderStamp() before it was tried.
WallContent missingContent(const ContentEntry& entry, std::string fault,
                           const std::optional<FileStamp>& tried);

// Which slide of a folder is wanted: the one after `from`, a file, in the order of their names, or
// the one before it. The default: the first one.
struct SlideTurn {
  std::string from{};
  bool back = false;
};

// Reads a content: a model as a whole, a picture's coarsest level only. Of slides it reads the
// first one after (or before) `turn.from`, cyclically, that can be shown, and tries its neighbours
// to see whether it is the first or the last slide; it adds to `skipped` a sentence about each
// slide on the way that cannot be shown. Errors: those of readMrmCopy(), openPicture(),
// openBelow(); kInvalidArgument (a model lacks the feature that `show` names); kNotFound (a folder
// without a pyramid that can be shown). O(size of a model's file).
Result<WallContent> readContent(const ContentEntry& entry,
                                const render::content::ShownFeature& show, const SlideTurn& turn,
                                std::vector<std::string>& skipped);

}  // namespace merlin::wall
