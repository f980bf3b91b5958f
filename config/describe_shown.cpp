#include "config/describe_shown.h"

namespace merlin {

void describeShown(ShownSettings& s, SettingsVisitor& v) {
  v.path("folder", s.folder,
         "The content folder: `merlin show FILE` puts what it makes of a file there, and merlind "
         "opens no other file that a client names. Members of the folder's group may write to it. "
         "Empty: INSTANCE.shown beside the file of the state (/state_file).");
  v.integer("limit_mb", s.limit_mb, {1, 1e6},
            "Maximum size of all files in the content folder together, in megabytes. After a file "
            "is shown, the oldest files are removed until the rest takes at most half of this "
            "size; the file that is shown, the one that was shown before it and those that the "
            "configuration names stay.");
}

}  // namespace merlin
