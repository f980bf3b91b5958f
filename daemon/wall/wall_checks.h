// Checks of the wall's settings against the files that they name. The loader of the configuration
// itself does not open these files.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/wall/wall_contents.h"

namespace merlin::wall {

// Reads the contents in the order in which they are shown: see contentsOf(). Adds a finding for
// each that names no file, cannot be read, or lacks the feature that /wall/render/show names. A
// content that cannot be read (its disk may not be there yet) is only an adjustment, and
// missingContent() stands for it in the result; this also holds if no content can be read. The
// result is complete if all findings are adjustments. O(size of the models' files).
std::vector<WallContent> readContents(LoadedSettings& loaded);

// Adds the findings of readContents(), but holds only one content in memory at a time. For a
// reload, which refuses what a start adjusts, as the findings say.
void checkContents(LoadedSettings& loaded);

// Adds a finding for each content with the same name as an earlier one, because commands would find
// the earlier one: see contentsOf(). Two names that the configuration itself gives are the loader's
// to compare. Reads no file.
void checkNames(LoadedSettings& loaded);

// Calls checkNames(). Then adds a finding for each name in /wall/playlist/contents that no content
// has, or that occurs twice. Reads no file.
void checkPlaylist(LoadedSettings& loaded);

// Adds a finding for each image file or snapshot folder that cannot be written, for each MPCDI file
// of a correction that cannot be read or lacks the output's region, and for each output of a kind
// that this installation lacks. At a start (`is_start`) an MPCDI file that cannot be read is only
// an adjustment: the output is shown without it.
void checkOutputs(LoadedSettings& loaded, bool is_start);

// Adds a finding if /wall/render/gpu names no GPU of this machine. Looks for GPUs only if it names
// one, which takes up to some tenths of a second for each.
void checkRenderer(LoadedSettings& loaded);

// Adds a finding with the JSON pointer `at` if `path`, which the daemon writes, is a file that it
// also reads and would thus overwrite.
void checkReplacesNothing(LoadedSettings& loaded, const std::string& path, const std::string& at);

}  // namespace merlin::wall
