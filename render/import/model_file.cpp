#include "render/import/model_file.h"

#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include "daemon/base/files.h"

namespace merlin::render::import {
namespace {

// Returns the memory that the sandbox allows this process to use, for a message.
std::string allowedMemory() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "there is";
  return fmt::format("the {} MB that are allowed", limit.rlim_cur >> 20);
}

}  // namespace

Error needsMoreMemory(const std::string& path) {
  return {Errc::kInvalidArgument,
          fmt::format("{}: reading it takes more memory than {} (--memory, by default the free "
                      "memory)",
                      path, allowedMemory())};
}

Result<BuiltModel> readModel(const ModelFile& file, const OnTriangles& on_triangles) {
  const auto named = [&](Errc code, const std::string& why) {
    return Error{code, file.path + ": " + why};
  };
  // Mapping the file reads no data, but shows whether the file is larger than the allowed memory,
  // which the libraries do not report.
  if (const auto whole = MappedFile::open(file.path);
      !whole && whole.error().code == Errc::kNoMemory)
    return needsMoreMemory(file.path);
  try {
    const bool coin = file.format == "iv" || file.format == "wrl";
    auto model = coin ? readByCoin(file, on_triangles) : readByAssimp(file, on_triangles);
    if (!model) return named(model.error().code, model.error().what);
    if (model->mesh.triangles.empty())
      return named(Errc::kUnsupported,
                   fmt::format("holds no surface{}{}", model->notes.empty() ? "" : "; ",
                               fmt::join(model->notes, "; ")));
    return model;
  } catch (const std::bad_alloc&) {
    return needsMoreMemory(file.path);
  } catch (const std::exception& e) {
    return named(Errc::kMalformed, fmt::format("cannot be read: {}", e.what()));
  }
}

}  // namespace merlin::render::import
