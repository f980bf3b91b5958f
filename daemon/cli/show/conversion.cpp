#include "daemon/cli/show/conversion.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/cli/print.h"
#include "daemon/cli/show/content_folder.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

Error tooLarge(const Conversion& conversion, std::uint64_t bytes) {
  return {Errc::kInvalidArgument,
          fmt::format("{}: takes {} MB on the wall; the content folder has room for {} MB "
                      "(/wall/shown/limit_mb)",
                      conversion.input, bytes / 1'000'000, conversion.most_bytes / 1'000'000)};
}

Result<Ok> copy(const Conversion& conversion, const ProgressListener& listener) {
  const auto stamp = fileStamp(conversion.input);
  if (stamp && stamp->size > conversion.most_bytes) return tooLarge(conversion, stamp->size);
  return copyFile(conversion.input, conversion.output,
                  [&](double share) { listener("copying", share); });
}

Result<Ok> convertFile(const Conversion& conversion, const MeshImport& mesh,
                       const ImageImport& image, const ProgressListener& listener) {
  if (conversion.kind == FileKind::kPicture) {
    ImageImport import = image;
    import.input = conversion.input;
    import.output = conversion.output;
    import.quiet = true;
    import.progress = listener;
    return importImage(import);
  }
  if (conversion.kind != FileKind::kMesh) return copy(conversion, listener);
  MeshImport import = mesh;
  import.inputs = {conversion.input};
  import.output = conversion.output;
  import.quiet = true;
  import.progress = listener;
  return importFile(import);
}

// Returns the names of the files in the folder, sorted, without hidden files. Errors: kIo.
Result<std::vector<std::string>> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;
    std::string name = it->path().filename().string();
    if (!name.starts_with('.') && it->is_regular_file(gone)) names.push_back(std::move(name));
  }
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", folder, error.message())};
  std::ranges::sort(names);
  return names;
}

// Returns the path of the slide for the file `name`: its name with the ending .tif instead of its
// own, or after its own if another file already has that slide.
std::string slideFor(const std::string& folder, const std::string& name) {
  const std::string slide = folder + "/" + fs::path(name).stem().string() + ".tif";
  std::error_code error;
  return fs::exists(slide, error) ? folder + "/" + name + ".tif" : slide;
}

// Converts one file of the folder to a slide. A file that is not a picture or cannot be read
// (kMalformed, kUnsupported) only causes a note; any other error is returned.
Result<Ok> addSlide(const Conversion& slide, const ImageImport& image,
                    const ProgressListener& listener) {
  if (slide.kind != FileKind::kPicture && slide.kind != FileKind::kPyramid) {
    printNote(slide.input + ": is not a picture; it is left out of the slides");
    return Ok{};
  }
  const auto made = convertFile(slide, {}, image, listener);
  const bool picture =
      !made && (made.error().code == Errc::kMalformed || made.error().code == Errc::kUnsupported);
  if (picture) printNote(made.error().what + "; it is left out of the slides");
  return picture ? Result<Ok>(Ok{}) : made;
}

Result<Ok> convertSlides(const Conversion& conversion, const ImageImport& image,
                         const ProgressListener& listener) {
  const auto names = filesIn(conversion.input);
  if (!names) return names.error();
  std::error_code error;
  fs::create_directory(conversion.output, error);
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", conversion.output, error.message())};
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < names->size(); ++i) {
    const std::string input = (fs::path(conversion.input) / (*names)[i]).string();
    const auto kind = kindOfFile(input, false);
    if (!kind) return kind.error();
    const Conversion slide{input, slideFor(conversion.output, (*names)[i]), *kind,
                           conversion.most_bytes - bytes};
    const auto added = addSlide(slide, image, [&](const std::string& title, double share) {
      listener(title, (static_cast<double>(i) + share) / static_cast<double>(names->size()));
    });
    if (!added) return added;
    bytes = sizeOfAll(conversion.output);
    if (bytes > conversion.most_bytes) return tooLarge(conversion, bytes);
  }
  if (bytes > 0) return Ok{};
  return Error{Errc::kNotFound,
               conversion.input + ": has no picture; a folder is shown as slides of its pictures"};
}

}  // namespace

Result<Ok> convert(const Conversion& conversion, const MeshImport& mesh, const ImageImport& image,
                   const ProgressListener& listener) {
  if (conversion.kind == FileKind::kSlides) return convertSlides(conversion, image, listener);
  auto made = convertFile(conversion, mesh, image, listener);
  if (!made) return made;
  const std::uint64_t bytes = sizeOfAll(conversion.output);
  return bytes <= conversion.most_bytes ? std::move(made) : tooLarge(conversion, bytes);
}

}  // namespace merlin::cli
