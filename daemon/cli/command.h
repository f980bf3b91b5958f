// The subcommands of the program merlin: functions that add them to the command line, and helpers.
#pragma once

#include <functional>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"

namespace merlin::cli {

// A function that executes the given subcommand and returns the exit status. The subcommand's
// callback sets it during parsing, and main() calls it afterwards.
using Run = std::function<int()>;

class RemoteOptions;

// Each of these functions adds one subcommand to `app`. `run` is set during parsing if that
// subcommand was given; it must outlive the parsing.
void addCalibrate(Command app, Run& run);
void addConfig(Command app, Run& run);
void addDevices(Command app, Run& run);
void addEmulate(Command app, Run& run);
void addFlight(Command app, Run& run);
void addGesture(Command app, Run& run);
void addImage(Command app, Run& run);
void addKeys(Command app, Run& run);
void addMesh(Command app, Run& run);
void addPosture(Command app, Run& run);
void addRecord(Command app, Run& run);
void addReplay(Command app, Run& run);
void addReload(Command app, Run& run);
void addReport(Command app, Run& run);
void addShm(Command app, Run& run);
void addShow(Command app, Run& run);
void addSnapshot(Command app, Run& run);
void addTrace(Command app, Run& run);
void addWall(Command app, Run& run);

// These functions add subcommands that can also communicate with a daemon on another machine.
// `remote` must outlive the execution of `run`.
void addCommandsByName(Command app, Run& run, RemoteOptions& remote);
void addStatus(Command app, Run& run, RemoteOptions& remote);
void addWatch(Command app, Run& run, RemoteOptions& remote);

// Prints "merlin: " and the error's text to stderr; returns the error's exit status.
int fail(const Error& error);

// Checks that the name of an output file ends in `ending`. `what`: kind of the file, for messages
// such as "shot.jpg: the name of a picture must end in .png". Errors: kInvalidArgument.
Result<Ok> checkEnding(const std::string& path, const char* what, const char* ending);

// Adds the option --instance, the name of the daemon on this machine that a subcommand communicates
// with.
void addInstance(Command app, std::string& instance);

}  // namespace merlin::cli
