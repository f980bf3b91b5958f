// Settings of outputs.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"

namespace merlin::render {

// In the order of kOutputKindNames.
enum class OutputKind { kSharedMemory, kPng };
inline constexpr const char* kOutputKindNames[] = {"shared_memory", "png"};
inline constexpr const char* nameOf(OutputKind kind) {
  return kOutputKindNames[static_cast<int>(kind)];
}

struct OutputSettings {
  OutputKind kind = OutputKind::kSharedMemory;
  std::string name{};      // empty: the kind's
  std::string path{};      // png: the file
  double interval_s = 60;  // png: between two files, at least

  std::string shownName() const { return name.empty() ? nameOf(kind) : name; }
};

// Number of outputs that shared memory has room to report on.
inline constexpr std::size_t kMostOutputs = 8;

// Everything that no wall can have: none or more than kMostOutputs, two of one name, a name of more
// than 23 characters, two in shared memory, a PNG file without a path, a setting of another kind.
// Pure.
SettingFaults validate(const std::vector<OutputSettings>& outputs);

}  // namespace merlin::render
