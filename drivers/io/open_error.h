// Why a port's file cannot be opened, for people.
#pragma once

#include <string>

#include "daemon/base/result.h"

namespace merlin::io {

// Of open() on `path`, which failed with the errno value `error`: kNotFound or kIo; without
// permission, the message names the group to join.
Error openError(const std::string& path, int error);

}  // namespace merlin::io
