// Describes and reads the contents that a wall can show: those of its configuration, and files of
// its content folder (ShownFolder).
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

// A content that can be shown. For slides, `path` is a folder.
struct ContentEntry {
  // JSON pointer of the setting that names the file; empty for a file of the content folder.
  std::string pointer;
  std::string name, path;
  ContentKind kind = ContentKind::kModel;
  // For pictures and slides only.
  render::content::ShowAs show_as = render::content::ShowAs::kAsMarked;
  // The content folder if the file is there: then no symbolic link below this folder is followed.
  // Empty: the configuration names the file, so its path is trusted.
  std::string below{};
};

// Returns the contents of the configuration in the order in which they are shown: first /wall/model
// if it names a file or /wall/contents is empty, then /wall/contents. An entry that names no file
// has an empty path.
std::vector<ContentEntry> contentsOf(const WallSettings& wall);

// Returns the names of the contents for a message, such as "left, right".
std::string namesOf(const std::vector<ContentEntry>& contents);

// Returns the default name of a content: the name of its file or folder without the ending.
std::string nameOf(const std::string& path);

// Returns the kind of content (kModel or kPicture) that the ending of a file name stands for;
// nothing for any other ending.
std::optional<ContentKind> kindByEnding(const std::string& name);

// Returns the indexes in `contents` of the contents with these names, in the order of `names`.
// Unknown names are omitted.
std::vector<std::size_t> placesOf(const std::vector<ContentEntry>& contents,
                                  const std::vector<std::string>& names);

// Returns the entry for a file or folder in the content folder `folder`. The ending of a file
// decides its kind; a folder becomes slides. `name`: name of the file or folder, or SLIDES/FILE.
// Errors: those of openBelow(); kInvalidArgument (unknown ending).
Result<ContentEntry> contentBelow(const std::string& folder, const std::string& name);

// A content that was read, or could not be read (`fault`).
struct WallContent {
  ContentEntry entry;
  std::string file;  // the file that was read: that of the entry, or one slide
  FileStamp stamp;   // stamp of `file`
  std::variant<render::lod::Dendrogram, std::shared_ptr<const render::content::Picture>> data;
  bool is_first_slide = false, is_last_slide = false;
  // For slides: a sentence about pictures in the folder in common formats such as JPEG, which are
  // not shown. Empty: there are none.
  std::string left_out{};
  // Why the content could not be read. Then `data` is an empty picture, and `stamp` is that of the
  // file or folder, if it exists. Empty: the content was read.
  std::string fault{};

  bool isModel() const noexcept { return data.index() == 0; }
};

// Returns a placeholder for a content that cannot be read yet. `fault`: the reason. `tried`:
// fileOrFolderStamp() of its path, taken before the attempt to read it.
WallContent missingContent(const ContentEntry& entry, std::string fault,
                           const std::optional<FileStamp>& tried);

// Says which slide of a folder to read: the one after the file `from` in the order of the names,
// or, if `back`, the one before it. With an empty `from`: the first one.
struct SlideTurn {
  std::string from{};
  bool back = false;
};

// Reads a content: a model completely, of a picture only the coarsest level. Of slides, it reads
// the first one after (or before) `turn.from`, cyclically, that can be shown, and tries its
// neighbours to find out whether it is the first or the last slide; it adds to `skipped` a sentence
// about each slide that it tried and that cannot be shown. Errors: those of readMrmCopy(),
// PyramidFile::open(), makePicture() and openBelow(); kInvalidArgument (a model lacks the feature
// that `show` names); kNotFound (the folder has no pyramid that can be shown). O(size of a model's
// file).
Result<WallContent> readContent(const ContentEntry& entry,
                                const render::content::ShownFeature& show, const SlideTurn& turn,
                                std::vector<std::string>& skipped);

}  // namespace merlin::wall
