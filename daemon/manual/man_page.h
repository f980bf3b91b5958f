// The manual page of a program, in the macros of man(7).
#pragma once

#include <string>

#include "daemon/manual/program.h"

namespace merlin::manual {

// Every command with its options and help. `version`: of the program, at the foot of the page.
std::string manPage(const ProgramCommand& program, const PageSettings& settings,
                    const std::string& version);

}  // namespace merlin::manual
