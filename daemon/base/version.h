// The version of the program, which CMakeLists.txt states.
#pragma once

namespace merlin {

// Returns the version, such as "0.1.0". Thread-safe.
const char* programVersion();

}  // namespace merlin
