// Sandbox: withdraws from this process what it must not have while it reads a hostile file: the
// network, other programs, files other than its inputs, its own folder and system files, and
// unlimited memory and time.
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

// Returns the files that a model may refer to, at most 4096: the visible files in the folder of
// `input` and in its visible subfolders, of which those named textures, images, maps and materials
// come first.
std::vector<std::string> filesBeside(const std::string& input);

// Closes the sandbox around this process; it cannot be opened again. `inputs`: files that may be
// read; `folder`: the one folder in which files may be written. Errors: kIo (a limit cannot be
// set). Returns the protections that this system lacks, in words for a person, such as "Landlock,
// which limits files"; empty if all are in effect.
Result<std::vector<std::string>> closeSandbox(const std::vector<std::string>& inputs,
                                              const std::string& folder, const Limits& limits);

// Limits the size of each file that is written from now on [bytes]; a write beyond it fails.
// Errors: kIo.
Result<Ok> limitFileSize(std::uint64_t bytes);

}  // namespace merlin::import
