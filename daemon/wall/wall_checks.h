// Checks of the wall's settings against the files that they name; the loader reads no other file.
#pragma once

#include <string>
#include <vector>

#include "config/loader.h"
#include "daemon/base/files.h"
#include "render/content/settings.h"
#include "render/lod/dendrogram.h"

namespace merlin::wall {

// A model that can be shown, and the file that it was read from.
struct Model {
  render::Dendrogram dendrogram;
  std::string path;
  FileStamp stamp;
};
// Errors: readMrmCopy()'s; kInvalidArgument, one without the feature that `show` names. O(file).
Result<Model> readModel(const std::string& path, const render::ShownFeature& show);

// The models, in the order in which they are shown: /wall/model, then /wall/contents. Adds
// findings: one that is not named or cannot be read, one without the feature that /wall/render/show
// names. The models are meaningful where it added none. O(files).
std::vector<Model> readModels(LoadedSettings& loaded);

// Adds findings: a picture's file or a folder of snapshots that cannot be written.
void checkOutputs(LoadedSettings& loaded);

}  // namespace merlin::wall
