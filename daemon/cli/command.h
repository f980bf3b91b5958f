// The subcommands of `merlin`: how each adds itself to the command line, and what they share.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/base/result.h"

namespace merlin::cli {

// Set by the subcommand that was chosen, called after parsing; returns the exit status.
using Run = std::function<int()>;

// One file each.
void addCalibrate(CLI::App& app, Run& run);
void addEmulate(CLI::App& app, Run& run);
void addFlight(CLI::App& app, Run& run);
void addKeys(CLI::App& app, Run& run);
void addMesh(CLI::App& app, Run& run);
void addPosture(CLI::App& app, Run& run);
void addRecord(CLI::App& app, Run& run);
void addReplay(CLI::App& app, Run& run);
void addShm(CLI::App& app, Run& run);
void addSnapshot(CLI::App& app, Run& run);
void addStatus(CLI::App& app, Run& run);
void addTrace(CLI::App& app, Run& run);
void addWall(CLI::App& app, Run& run);
void addWatch(CLI::App& app, Run& run);

// Prints "merlin: WHAT" to stderr; returns the exit status that belongs to the error.
int fail(const Error& error);

// The option --instance, which every subcommand that speaks to a daemon has.
void addInstance(CLI::App& app, std::string& instance);

}  // namespace merlin::cli
