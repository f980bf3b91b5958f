// Checks of the wall's settings against the files that they name. The loader of the configuration
// itself does not open these files.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/wall/wall_contents.h"

namespace merlin::wall {

// Reads the contents of the configuration in the order of contentsOf(). Adds a finding for each
// content that names no file, cannot be read, or lacks the feature that /wall/render/show names. If
// a content cannot be read (its disk may not be mounted yet), the finding is only an adjustment,
// and the result contains missingContent() in its place, even if no content can be read. The result
// is complete if all findings are adjustments. O(size of the models' files).
std::vector<WallContent> readContents(LoadedSettings& loaded);

// Adds the findings of readContents(), but keeps only one content in memory at a time. For a
// reload, which refuses contents that cannot be read, unlike a start; the findings say so.
void checkContents(LoadedSettings& loaded);

// Adds a finding for each content that has the same name as an earlier one of contentsOf(), because
// commands would find only the earlier one. Two names that are both given in the configuration are
// not compared here, since the loader compares them. Reads no file.
void checkNames(LoadedSettings& loaded);

// Calls checkNames(). Then adds a finding for each name in /wall/playlist/contents that no content
// has or that occurs twice. Reads no file.
void checkPlaylist(LoadedSettings& loaded);

// Adds a finding for each image file, snapshot folder or content folder that cannot be written; for
// each image file that is not a PNG file or that the daemon also reads; for each MPCDI file of a
// correction that cannot be read or lacks the output's region, and, as an adjustment, if the region
// may not fit the output; and for each output of a kind that this installation lacks. At a start
// (`is_start`), an unusable MPCDI file is only an adjustment: the output is shown without it.
void checkOutputs(LoadedSettings& loaded, bool is_start);

// Adds a finding if /wall/render/gpu names a GPU that this machine does not have. Only if it names
// one, GPUs are looked for, which takes up to some tenths of a second for each GPU.
void checkRenderer(LoadedSettings& loaded);

// Adds a finding with the JSON pointer `at` if `path`, a file that the daemon writes, is also a
// file that it reads and would thus overwrite.
void checkReplacesNothing(LoadedSettings& loaded, const std::string& path, const std::string& at);

}  // namespace merlin::wall
