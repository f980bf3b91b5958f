// merlin image import: makes a tiled pyramid of a picture of any format.
#include "daemon/cli/image/image_import.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/image/image.h"
#include "daemon/cli/import_child.h"
#include "daemon/cli/print.h"
#include "daemon/cli/progress.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/cli/work_folder.h"
#include "render/image/pyramid_file.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

// Syncs the result to the disk, then renames it, so that readers see either the old file or the
// complete new one.
Result<Ok> moveInto(const std::string& from, const std::string& to) {
  const UniqueFd file(::open(from.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid() || ::fsync(file.get()) != 0 || ::rename(from.c_str(), to.c_str()) != 0)
    return Error{Errc::kIo, fmt::format("{}: {}", to, std::strerror(errno))};
  return Ok{};
}

struct Summary {
  double seconds = 0;
  std::uint64_t peak_bytes = 0;
  std::vector<std::string> lacks, notes;
};

void printSummary(const ImageImport& options, const render::image::PyramidFile& file,
                  const Summary& summary) {
  const auto& finest = file.levels().front();
  const double pixels = static_cast<double>(finest.width) * static_cast<double>(finest.height);
  const double rate = pixels / std::max(summary.seconds, 1e-3);
  if (options.json) {
    printJsonLine(nlohmann::ordered_json{{"file", options.output},
                                         {"kind", file.isPanorama() ? "panorama" : "picture"},
                                         {"width", finest.width},
                                         {"height", finest.height},
                                         {"levels", file.levels().size()},
                                         {"bytes", file.stamp().size},
                                         {"seconds", summary.seconds},
                                         {"pixels_per_s", rate},
                                         {"peak_memory_bytes", summary.peak_bytes},
                                         {"lacks", summary.lacks},
                                         {"notes", summary.notes}});
    return;
  }
  printOut(
      "{}: {} of {} x {} pixels, {} levels, {:.1f} MB; {:.1f} s, {:.1f} million pixels/s, at most "
      "{:.0f} MB of memory\n",
      options.output, file.isPanorama() ? "panorama" : "picture", finest.width, finest.height,
      file.levels().size(), static_cast<double>(file.stamp().size) / 1e6, summary.seconds,
      rate / 1e6, static_cast<double>(summary.peak_bytes) / 1e6);
}

// Runs the import in `folder` until `stop` is readable. Returns the path of the result there.
Result<std::string> runImport(const ImageImport& options, const std::string& folder, int stop,
                              Summary& summary) {
  std::vector<std::string> arguments = {"picture",
                                        options.input,
                                        folder,
                                        "--quality",
                                        std::to_string(options.quality),
                                        "--tile",
                                        std::to_string(options.tile_px),
                                        "--memory",
                                        std::to_string(options.memory)};
  if (options.panorama) arguments.emplace_back("--panorama");
  if (!options.range.empty()) {
    arguments.emplace_back("--range");
    arguments.push_back(fmt::format("{}:{}", options.range[0], options.range[1]));
  }
  auto child = ImportChild::start(arguments);
  if (!child) return child.error();
  const SystemClock clock;
  const Timestamp began = clock.now();
  const std::string title = "importing";
  ProgressBar bar(title, "pixels", clock);
  const auto name = child->follow(stop, [&](const ImportReport& report) {
    bar.update(report.share(), report.items());
    if (options.progress) options.progress(title, report.share());
  });
  if (name) bar.finish(child->report().pixels());
  summary.seconds = toSeconds(clock.now() - began);
  summary.lacks = child->report().lacks();
  summary.notes = child->report().notes();
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  summary.peak_bytes = static_cast<std::uint64_t>(used.ru_maxrss) * 1024;
  if (!name) return name.error();
  return folder + "/" + *name;
}

Result<Ok> checkOptions(const ImageImport& options) {
  if (const auto ending = checkEnding(options.output, "pyramid", ".tif"); !ending) return ending;
  if (!fileStamp(options.input)) {
    std::error_code error;
    const char* const is = fs::is_directory(options.input, error)
                               ? "is a folder; merlin show FOLDER shows its pictures as slides"
                           : fs::exists(options.input, error) ? "is not a file"
                                                              : "does not exist";
    return Error{Errc::kNotFound, fmt::format("{}: {}", options.input, is)};
  }
  if (!options.range.empty() && !(options.range[0] < options.range[1]))
    return Error{Errc::kInvalidArgument,
                 fmt::format("--range {} {}: the first value, which becomes black, has to be less "
                             "than the second",
                             options.range[0], options.range[1])};
  return checkWritable(options.output);
}

}  // namespace

Result<Ok> importImage(const ImageImport& options) {
  if (const auto good = checkOptions(options); !good) return good.error();
  // Called before the folder is made, because a signal would otherwise leave the folder behind.
  const UniqueFd stop = stopSignals();
  const auto folder = WorkFolder::make(options.output);
  if (!folder) return folder.error();
  Summary summary;
  const auto made = runImport(options, folder->path(), stop.get(), summary);
  for (const std::string& what : summary.lacks)
    printNote(fmt::format("this system lacks {}; the import ran without it", what));
  for (const std::string& note : summary.notes) printNote(options.input + ": " + note);
  if (!made) return made.error();
  // Opens the result as the daemon does, so that a file that the daemon would refuse is not left
  // behind.
  const auto read = render::image::PyramidFile::open(*made);
  if (!read) return Error{Errc::kIo, "the result cannot be used: " + read.error().what};
  if (const auto moved = moveInto(*made, options.output); !moved) return moved.error();
  if (!options.quiet) printSummary(options, **read, summary);
  return Ok{};
}

void addImageImport(Command image, Run& run) {
  const auto options = std::make_shared<ImageImport>();
  Command command = image.subcommand(
      "import",
      "Convert a picture (JPEG, PNG, TIFF, WebP, HDR, PPM, FITS and whatever else libvips reads) "
      "into a tiled pyramid, the form in which merlind shows pictures of any size. The program "
      "merlin-import reads it in a sandbox without network, and with limited files and memory. "
      "The result appears as a whole, or not at all.\n"
      "Example: merlin image import photo.jpg -o photo.tif");
  command.option("in", options->input, "Picture").required().typeName("FILE");
  command.option("-o,--output", options->output, "Pyramid to write (.tif)")
      .required()
      .typeName("FILE");
  command.flag("--panorama", options->panorama,
               "The picture is equirectangular (360 x 180 degrees): it is shown with the viewer "
               "inside");
  command.option("--quality", options->quality, "Quality of JPEG, 1 to 100; 0: lossless, larger")
      .range(0, 100)
      .showDefault();
  command.option("--tile", options->tile_px, "Width and height of the tiles in pixels, 256 or 512")
      .check([](const std::string& value) {
        return value == "256" || value == "512" ? std::string() : value + " is neither 256 nor 512";
      })
      .showDefault();
  command
      .option("--range", options->range,
              "The values that become black and white. By default measured values (floats, signed "
              "and 32-bit integers, and grey of 16 bits that ends below 16384) are shown from the "
              "lowest to the highest value of the picture, without a thousandth of them at either "
              "end, and a note gives the two values; colours stay as they are")
      .typeName("LOW HIGH")
      .expected(2);
  command
      .option("--memory", options->memory,
              "Address space that the import may take; about 0.5 GB are needed for any size of "
              "picture that can be read row by row")
      .size()
      .typeName("SIZE");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] {
    run = [options] {
      const auto done = importImage(*options);
      return done ? kExitDone : fail(done.error());
    };
  });
}

}  // namespace merlin::cli
