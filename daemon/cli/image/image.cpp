// merlin image: adds its subcommands.
#include "daemon/cli/image/image.h"

namespace merlin::cli {

void addImage(Command app, Run& run) {
  Command image = app.subcommand("image", "Pictures and panoramas of any size: import, inspect.");
  image.requireSubcommand();
  addImageImport(image, run);
  addImageInfo(image, run);
}

}  // namespace merlin::cli
