// merlin config: commands for configuration files.
#include "daemon/cli/config/config.h"

#include "daemon/cli/print.h"

namespace merlin::cli {

Result<LoadedSettings> loadPrinted(const std::string& file) {
  LoadedSettings loaded = loadSettingsFile(file);
  for (const Finding& finding : loaded.findings) printError("{}\n", toText(file, finding));
  if (loaded.left_out > 0) printError("{}: and {} more findings\n", oneLine(file), loaded.left_out);
  if (loaded.verdict() != LoadedSettings::Verdict::kInvalid) return loaded;
  return Error{Errc::kInvalidArgument, file + ": the configuration is invalid"};
}

void addConfig(Command app, Run& run) {
  Command config =
      app.subcommand("config", "Show, compare, edit and migrate configuration files of merlind.");
  config.requireSubcommand();
  addConfigShow(config, run);
  addConfigDiff(config, run);
  addConfigEdit(config, run);
  addConfigMigrate(config, run);
}

}  // namespace merlin::cli
