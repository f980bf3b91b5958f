#include "daemon/wall/wall_checks.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/content/shown_colours.h"
#include "render/correct/io/mpcdi.h"
#include "render/lod/io/mrm_file.h"
#include "render/out/output_kinds.h"

namespace merlin::wall {
namespace {

constexpr const char* kCannot = "cannot be used: ";

struct ModelSetting {
  std::string pointer, path;
};

std::vector<ModelSetting> modelsOf(const WallSettings& wall) {
  std::vector<ModelSetting> models = {{"/wall/model", wall.model}};
  for (std::size_t i = 0; i < wall.contents.size(); ++i)
    models.push_back({fmt::format("/wall/contents/{}/model", i), wall.contents[i].model});
  return models;
}

}  // namespace

Result<Model> readModel(const std::string& path, const render::content::ShownFeature& show) {
  FileStamp stamp;
  auto model = render::lod::readMrmCopy(path, &stamp);
  if (!model) return model.error();
  if (const auto shown = render::content::checkShown(*model, show); !shown)
    return Error{Errc::kInvalidArgument, fmt::format("{}: {}", path, shown.error().what)};
  return Model{*std::move(model), path, stamp};
}

std::vector<Model> readModels(LoadedSettings& loaded) {
  std::vector<Model> models;
  for (const auto& [pointer, path] : modelsOf(loaded.settings.wall)) {
    if (path.empty()) {
      loaded.wrong(pointer, "names no .mrm file (make one with: merlin mesh reduce IN -o OUT.mrm)");
      continue;
    }
    auto model = readModel(path, loaded.settings.wall.render.model.show);
    if (model) {
      models.push_back(*std::move(model));
      continue;
    }
    const bool shows = model.error().code == Errc::kInvalidArgument;
    loaded.wrong(shows ? "/wall/render/show" : pointer, kCannot + model.error().what);
  }
  return models;
}

namespace {

// Adds a finding if the output would overwrite an existing file that is not a PNG image.
void checkIsPicture(LoadedSettings& loaded, const std::string& path, const std::string& at) {
  std::ifstream there(path, std::ios::binary);
  char signature[8] = {};
  there.read(signature, sizeof signature);
  if (there.gcount() > 0 && std::string_view(signature, sizeof signature) != "\x89PNG\r\n\x1a\n") {
    loaded.wrong(at,
                 path + ": exists and is not a PNG file; name another file, or remove this one");
  }
}

void checkMeasured(LoadedSettings& loaded, const render::correct::CorrectionSettings& correction,
                   const std::string& at) {
  if (correction.mpcdi.empty()) return;
  const auto measured = render::correct::readMeasured(correction.mpcdi, correction.mpcdi_region);
  if (measured) return;
  const bool region = measured.error().code == Errc::kInvalidArgument;
  loaded.wrong(at + (region ? "/mpcdi_region" : "/mpcdi"), kCannot + measured.error().what);
}

}  // namespace

void checkReplacesNothing(LoadedSettings& loaded, const std::string& path, const std::string& at) {
  const Settings& s = loaded.settings;
  std::vector<std::string> read = {s.devices.postures, s.serve.samples_keys,
                                   s.serve.samples_clients, s.wall.input.keys};
  for (const auto& [pointer, model] : modelsOf(s.wall)) read.push_back(model);
  for (const render::out::OutputSettings& output : s.wall.outputs)
    read.push_back(output.correction.mpcdi);
  for (const std::string& other : read) {
    std::error_code error;
    if (other.empty() || !std::filesystem::equivalent(other, path, error)) continue;
    loaded.wrong(
        at, fmt::format("names {}, which the daemon also reads; it would be overwritten", other));
  }
}

void checkOutputs(LoadedSettings& loaded) {
  const WallSettings wall = loaded.settings.wall;
  for (std::size_t i = 0; i < wall.outputs.size(); ++i) {
    checkMeasured(loaded, wall.outputs[i].correction,
                  fmt::format("/wall/outputs/{}/correction", i));
    if (const auto there = render::out::checkIsThere(wall.outputs[i].kind); !there) {
      loaded.wrong(
          fmt::format("/wall/outputs/{}/kind", i),
          fmt::format("cannot be {}: {}", nameOf(wall.outputs[i].kind), there.error().what));
    }
    const std::string& path = wall.outputs[i].path;
    if (path.empty()) continue;
    const std::string at = fmt::format("/wall/outputs/{}/path", i);
    checkReplacesNothing(loaded, path, at);
    checkIsPicture(loaded, path, at);
    if (const auto writable = checkWritable(path); !writable)
      loaded.wrong(at, kCannot + writable.error().what);
  }
  if (!wall.snapshots.empty()) {
    if (const auto usable = checkFolder(wall.snapshots); !usable)
      loaded.wrong("/wall/snapshots", kCannot + usable.error().what);
  }
}

}  // namespace merlin::wall
