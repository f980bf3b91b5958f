// merlin config migrate: rewrites a configuration of an earlier version.
#include <memory>

#include <fmt/format.h>

#include "config/migrate.h"
#include "daemon/base/files.h"
#include "daemon/cli/config/config.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/json/json_tree.h"

namespace merlin::cli {
namespace {

struct MigrateOptions {
  std::string input, output;
};

int migrateFile(const MigrateOptions& options) {
  const auto file = FileCopy::read(options.input, kMostJsonBytes + 1);
  if (!file) return fail(file.error());
  const auto migrated = migrate(file->text());
  if (!migrated)
    return fail({Errc::kInvalidArgument, options.input + ": " + migrated.error().what});
  for (const std::string& change : migrated->changes) printOut("{}: {}\n", options.input, change);
  if (migrated->changes.empty())
    printOut("{}: has the form of this version already\n", options.input);
  const bool in_place = options.output.empty();
  if (in_place && migrated->changes.empty()) return kExitDone;
  if (in_place) {
    const std::string kept = options.input + ".old";
    if (fileStamp(kept)) {
      return fail({Errc::kInvalidArgument,
                   kept + ": exists already; remove it, or choose another output file with -o"});
    }
    if (const auto written = writeFile(kept, file->text()); !written) return fail(written.error());
    printOut("{}: copy of the original file\n", kept);
  }
  const auto written = writeFile(in_place ? options.input : options.output, migrated->text);
  return written ? int{kExitDone} : fail(written.error());
}

}  // namespace

void addConfigMigrate(Command config, Run& run) {
  const auto options = std::make_shared<MigrateOptions>();
  Command command = config.subcommand(
      "migrate",
      "Rewrite a configuration of an earlier version in the form of this version. The original "
      "file is kept as FILE.old.\nExample: merlin config migrate /etc/merlin/merlin.json");
  command.option("file", options->input, "The configuration file").required().typeName("FILE");
  command.option("-o", options->output, "Write the result into this file, and leave FILE unchanged")
      .typeName("FILE");
  command.callback([options, &run] { run = [options] { return migrateFile(*options); }; });
}

}  // namespace merlin::cli
