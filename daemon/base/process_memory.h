// Memory of this process: how much is available to it, and how much it has used.
#pragma once

#include <cstddef>
#include <optional>

namespace merlin {

// The machine's available memory in bytes; nothing if it is unknown. Cost: reads a file in /proc.
std::optional<std::size_t> availableMemory();

// Memory in bytes that this process may use: the smaller of 15/16 of availableMemory() and 7/8 of
// the address space that this process may still use (ulimit -v). A very large number if neither is
// known. Cost: reads two files in /proc.
std::size_t freeMemory();

// Peak resident memory of this process so far in bytes, mapped files included.
std::size_t peakMemory();

}  // namespace merlin
