// merlin image info: shows what a pyramid contains.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/image/image.h"
#include "daemon/cli/print.h"
#include "render/image/pyramid_file.h"

namespace merlin::cli {
namespace {

struct ImageInfoOptions {
  std::string file;
  bool json = false;
};

int imageInfo(const ImageInfoOptions& options) {
  const auto file = render::image::PyramidFile::open(options.file);
  if (!file) return fail(file.error());
  const char* const kind = (*file)->isPanorama() ? "panorama" : "picture";
  auto levels = nlohmann::ordered_json::array();
  for (const render::image::PyramidLevel& l : (*file)->levels())
    levels.push_back({{"width", l.width}, {"height", l.height}});
  const auto& finest = (*file)->levels().front();
  if (options.json) {
    printJsonLine(nlohmann::ordered_json{{"kind", kind},
                                         {"width", finest.width},
                                         {"height", finest.height},
                                         {"levels", levels},
                                         {"bytes", (*file)->stamp().size}});
    return kExitDone;
  }
  printOut("{}: {} of {} x {} pixels, {:.1f} MB\n", options.file, kind, finest.width, finest.height,
           static_cast<double>((*file)->stamp().size) / 1e6);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto& l = (*file)->levels()[i];
    printOut("  level {:2}  {} x {}\n", i, l.width, l.height);
  }
  return kExitDone;
}

}  // namespace

void addImageInfo(Command image, Run& run) {
  const auto options = std::make_shared<ImageInfoOptions>();
  Command command = image.subcommand("info",
                                     "Show the size, the kind and the levels of a pyramid.\n"
                                     "Example: merlin image info photo.tif");
  command.option("file", options->file, "Pyramid (.tif)").required().typeName("FILE");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return imageInfo(*options); }; });
}

}  // namespace merlin::cli
