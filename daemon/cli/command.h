// The subcommands of `merlin`: how each adds itself to the command line, and what they share.
#pragma once

#include <functional>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"

namespace merlin::cli {

// Set by the subcommand that was chosen, called after parsing; returns the exit status.
using Run = std::function<int()>;

// One file each.
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

// Prints "merlin: WHAT" to stderr; returns the exit status that belongs to the error.
int fail(const Error& error);

// Whether a file that a command writes is named after what it is: "shot.jpg: a picture's name ends
// in .png". Errors: kInvalidArgument.
Result<Ok> checkEnding(const std::string& path, const char* what, const char* ending);

// The option --instance, which every subcommand that speaks to a daemon has.
void addInstance(Command app, std::string& instance);

}  // namespace merlin::cli
