// merlin config diff: prints the settings that differ between a configuration and the defaults, or
// between two configurations.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/effective.h"
#include "daemon/cli/config/config.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

struct DiffOptions {
  std::string file = kUsualConfig, other;
  bool json = false;
};

std::string shown(const std::string& value) { return value.empty() ? "(absent)" : value; }

Json parsedValue(const std::string& value) {
  return value.empty() ? Json(nullptr) : Json::parse(value, nullptr, false);
}

void print(const std::vector<SettingChange>& changes, bool json) {
  Json list = Json::array();
  for (const SettingChange& c : changes) {
    if (json)
      list.push_back({{"pointer", c.pointer},
                      {"before", parsedValue(c.before)},
                      {"after", parsedValue(c.after)}});
    else
      printOut("{}: {} -> {}\n", c.pointer, shown(c.before), shown(c.after));
  }
  if (json) printJsonLine(list);
}

int diff(const DiffOptions& options) {
  const auto file = loadPrinted(options.file);
  if (!file) return fail(file.error());
  if (options.other.empty()) {
    print(changesFromDefaults(file->settings), options.json);
    return kExitDone;
  }
  const auto other = loadPrinted(options.other);
  if (!other) return fail(other.error());
  print(changesBetween(file->settings, other->settings), options.json);
  return kExitDone;
}

}  // namespace

void addConfigDiff(Command config, Run& run) {
  const auto options = std::make_shared<DiffOptions>();
  Command command = config.subcommand(
      "diff",
      "Show what differs between the defaults and a configuration, or between two "
      "configurations, each with the conf.d beside it: one setting per line, as POINTER: OLD -> "
      "NEW.\nExample: merlin config diff /etc/merlin/merlin.json new.json");
  command.option("file", options->file, "The configuration").typeName("FILE").showDefault();
  command
      .option("other", options->other,
              "The configuration to compare FILE with; the default values if none is given")
      .typeName("OTHER");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return diff(*options); }; });
}

}  // namespace merlin::cli
