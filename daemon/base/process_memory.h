// Memory of this process: how much is available to it, and how much it has used.
#pragma once

#include <cstddef>
#include <optional>

namespace merlin {

// Returns the machine's available memory [bytes]; nothing if it is unknown. Cost: reads a file in
// /proc.
std::optional<std::size_t> availableMemory();

// Returns the memory that this process may use [bytes]: the smaller of 15/16 of availableMemory()
// and 7/8 of the address space that this process may still use (ulimit -v). A very large number if
// neither is known. Cost: reads two files in /proc.
std::size_t freeMemory();

// Returns the peak resident memory of this process so far [bytes], mapped files included.
std::size_t peakMemory();

}  // namespace merlin
