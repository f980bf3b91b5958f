#include "render/import/model_file.h"

#include <exception>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::render::import {

Result<BuiltModel> readModel(const ModelFile& file, const OnTriangles& on_triangles) {
  const auto named = [&](Errc code, const std::string& why) {
    return Error{code, file.path + ": " + why};
  };
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
    return named(Errc::kInvalidArgument, "reading it takes more memory than is allowed (--memory)");
  } catch (const std::exception& e) {
    return named(Errc::kMalformed, fmt::format("cannot be read: {}", e.what()));
  }
}

}  // namespace merlin::render::import
