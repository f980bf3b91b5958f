// Unpacks files that gzip packed (RFC 1952), as Open Inventor and VRML files often are.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::render::mesh {

bool isGzip(std::string_view bytes) noexcept;

// The first bytes of what is packed, at most `most`; empty if there is nothing, or it is damaged.
std::string gunzipBeginning(std::string_view bytes, std::size_t most);

// All that is packed. Memory is taken as it is filled, whatever the file says of its size. Errors,
// without the file's name: kMalformed (damaged or cut), kUnsupported (more than `most` bytes).
Result<std::string> gunzip(std::string_view bytes, std::size_t most);

// Why a packed file is refused where none is unpacked, without its name: kMalformed (damaged, with
// the place, or cut), else kUnsupported with the way out. Unpacks up to 1 GiB, but keeps nothing.
// REQUIRES: isGzip(bytes).
Error packedFileError(std::string_view bytes);

}  // namespace merlin::render::mesh
