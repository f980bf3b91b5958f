// Where the configuration is, if nobody says where.
#pragma once

namespace merlin {

inline constexpr const char* kUsualConfig = "/etc/merlin/merlin.json";

}  // namespace merlin
