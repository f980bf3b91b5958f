// merlin config show: prints the settings in effect and the origin of each value.
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "daemon/cli/config/config.h"
#include "daemon/cli/config/shown_settings.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/state/state_folder.h"

namespace merlin::cli {
namespace {

struct ConfigShowOptions {
  std::string file = kUsualConfig;
  bool changed = false, json = false;
};

std::optional<RunTimeChanges> changesOf(const Settings& settings) {
  const std::string file = state::findStateFile(settings.state_file, settings.instance);
  const auto text = state::StateFolder(file).read();
  if (!text) {
    if (text.error().code != Errc::kNotFound) printNote(text.error().what);
    return std::nullopt;
  }
  auto state = state::parseState(*text, file);
  if (state) return RunTimeChanges{file, *std::move(state)};
  printNote(state.error().what);
  return std::nullopt;
}

int showConfig(const ConfigShowOptions& options) {
  const auto loaded = loadPrinted(options.file);
  if (!loaded) return fail(loaded.error());
  const auto changes = changesOf(loaded->settings);
  auto settings = shownSettings(*loaded, options.file, changes ? &*changes : nullptr);
  if (options.changed) std::erase_if(settings, [](const ShownSetting& s) { return !s.differs(); });
  if (options.json) {
    fmt::print("{}\n", settingsJson(settings));
    return kExitDone;
  }
  printOut("{}", settingsLines(settings));
  if (changes) printOut("{}", changesLines(*changes));
  return kExitDone;
}

}  // namespace

void addConfigShow(Command config, Run& run) {
  const auto options = std::make_shared<ConfigShowOptions>();
  Command command = config.subcommand(
      "show",
      "Show every setting in effect: its value, a star if that differs from the default, and where "
      "it comes from: the configuration, a file of conf.d beside it, or what people changed while "
      "the wall ran.\nExample: merlin config show --changed");
  command.option("file", options->file, "The configuration").typeName("FILE").showDefault();
  command.flag("--changed", options->changed, "Only settings that differ from the default");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return showConfig(*options); }; });
}

}  // namespace merlin::cli
