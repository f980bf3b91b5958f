#pragma once

namespace merlin {

// MERLIN's version as CMakeLists.txt states it: "0.1.0". Any thread.
const char* programVersion();

}  // namespace merlin
