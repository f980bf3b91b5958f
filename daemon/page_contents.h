// Lists the contents of a configuration's wall for the operator's page.
#pragma once

#include <vector>

#include "config/settings.h"
#include "daemon/page/thumbnails.h"

namespace merlin {

// Returns the contents in the order in which the wall shows them; an entry that names no file is
// left out. Pictures, and the first slide of a folder, are read as the wall reads them, with its
// checks and limits.
std::vector<page::PageContent> pageContents(const WallSettings& wall);

}  // namespace merlin
