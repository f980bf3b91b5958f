// The subcommands of `merlin`: functions that add them to the command line, and shared helpers.
#pragma once

#include <functional>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"

namespace merlin::cli {

// Set by the subcommand that was chosen, called after parsing; returns the exit status.
using Run = std::function<int()>;

// Each is defined in a file of its own.
void addCalibrate(Command app, Run& run);
void addCommandsByName(Command app, Run& run);
void addConfig(Command app, Run& run);
void addEmulate(Command app, Run& run);
void addFlight(Command app, Run& run);
void addKeys(Command app, Run& run);
void addMesh(Command app, Run& run);
void addPosture(Command app, Run& run);
void addRecord(Command app, Run& run);
void addReplay(Command app, Run& run);
void addShm(Command app, Run& run);
void addSnapshot(Command app, Run& run);
void addStatus(Command app, Run& run);
void addTrace(Command app, Run& run);
void addWall(Command app, Run& run);
void addWatch(Command app, Run& run);

// Prints "merlin: WHAT" to stderr; returns the error's exit status.
int fail(const Error& error);

// Checks that the name of an output file ends in `ending`. `what`: the kind of file, for the
// message "shot.jpg: the name of a picture must end in .png". Errors: kInvalidArgument.
Result<Ok> checkEnding(const std::string& path, const char* what, const char* ending);

// Adds the option --instance, which every subcommand that speaks to a daemon has.
void addInstance(Command app, std::string& instance);

}  // namespace merlin::cli
