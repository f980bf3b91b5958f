#include "daemon/base/version.h"

namespace merlin {

const char* programVersion() { return MERLIN_VERSION; }

}  // namespace merlin
