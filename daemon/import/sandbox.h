// Sandbox: takes from this process what reading a hostile file must not have: the network, other
// programs, files other than its input and its own folder, and memory and time without bound.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::import {

struct Limits {
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  // address space
  std::uint64_t cpu_s = 12 * 3600;                      // CPU time of all threads
};

// The files that a model may name, at most 4096: the visible ones in the folder of `input`, and in
// the visible folders of it, textures, images, maps and materials first.
std::vector<std::string> filesBeside(const std::string& input);

// Closes the sandbox around this process, for good. `inputs`: files that may be read; `folder`: the
// one folder in which files may be written. Errors: kIo (a limit cannot be set). Returns what this
// system lacks, in words for a person: "landlock (files)", for example; empty if all holds.
Result<std::vector<std::string>> closeSandbox(const std::vector<std::string>& inputs,
                                              const std::string& folder, const Limits& limits);

// Limits the size of each file that is written from now on [bytes].
Result<Ok> limitFileSize(std::uint64_t bytes);

}  // namespace merlin::import
