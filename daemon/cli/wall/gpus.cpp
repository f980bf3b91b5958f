#include "daemon/cli/wall/gpus.h"

#include <memory>

#include <nlohmann/json.hpp>

#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "render/gl/gpu_list.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

Json gpuJson(const render::gl::Gpu& gpu) {
  const render::gl::RendererInfo& r = gpu.renderer;
  return {{"name", r.name},   {"vendor", r.vendor}, {"driver", r.driver},     {"node", r.node},
          {"card", gpu.card}, {"pci", r.pci},       {"software", r.software}, {"fault", gpu.fault}};
}

int printGpus(bool json) {
  const std::vector<render::gl::Gpu> gpus = render::gl::listGpus();
  if (json) {
    Json list = Json::array();
    for (const render::gl::Gpu& gpu : gpus) list.push_back(gpuJson(gpu));
    printJsonLine(list);
    return kExitDone;
  }
  for (const std::string& line : render::gl::describeGpus(gpus)) printOut("{}\n", line);
  if (gpus.empty()) printNote("EGL lists no GPU and no software renderer");
  return kExitDone;
}

}  // namespace

void addGpus(Command wall, Run& run) {
  const auto json = std::make_shared<bool>(false);
  Command command = wall.subcommand(
      "gpus",
      "List the GPUs of this machine, as /wall/render/gpu names them: by number, by a part of the "
      "name, or by DRM node or PCI address. The software renderer is in the list too.\n"
      "Example: merlin wall gpus");
  command.flag("--json", *json, "One JSON array on one line");
  command.callback([json, &run] { run = [json] { return printGpus(*json); }; });
}

}  // namespace merlin::cli
