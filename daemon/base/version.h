// The version of the program, which CMakeLists.txt states.
#pragma once

namespace merlin {

// "0.1.0". Any thread.
const char* programVersion();

}  // namespace merlin
