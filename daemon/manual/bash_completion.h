// Completion of a program's commands, options and values, for bash.
#pragma once

#include <string>

#include "daemon/manual/program.h"

namespace merlin::manual {

// A script that bash reads. Where a value is not one of a few words, bash completes file names.
std::string bashCompletion(const ProgramCommand& program, const std::string& name);

}  // namespace merlin::manual
