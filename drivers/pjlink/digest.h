// MD5, as PJLink's authentication uses it.
#pragma once

#include <string>
#include <string_view>

namespace merlin::pjlink {

// Returns the MD5 digest (RFC 1321) of the bytes, as 32 hexadecimal digits in lower case.
std::string md5Hex(std::string_view bytes);

}  // namespace merlin::pjlink
