// The path of the configuration that merlin and merlind use if none is given.
#pragma once

namespace merlin {

inline constexpr const char* kUsualConfig = "/etc/merlin/merlin.json";

}  // namespace merlin
