#include "render/out/settings.h"

#include <set>

#include <fmt/format.h>

namespace merlin::render {
namespace {

constexpr std::size_t kLongestName = 23;

void checkOne(const OutputSettings& o, const std::string& at, SettingFaults& faults) {
  if (o.shownName().size() > kLongestName) {
    faults.push_back({at + "/name", fmt::format("has {} characters; at most {} are allowed",
                                                o.shownName().size(), kLongestName)});
  }
  if (o.kind == OutputKind::kPng && o.path.empty())
    faults.push_back({at, "has no path; an output of kind png needs the name of its file"});
  if (o.kind != OutputKind::kPng && !o.path.empty())
    faults.push_back({at + "/path", fmt::format("is not a setting of kind {}", nameOf(o.kind))});
}

}  // namespace

SettingFaults validate(const std::vector<OutputSettings>& outputs) {
  SettingFaults faults;
  if (outputs.empty()) faults.push_back({"", "is an empty list; a wall has at least one output"});
  if (outputs.size() > kMostOutputs) {
    faults.push_back(
        {"", fmt::format("has {} outputs; a wall has at most {}", outputs.size(), kMostOutputs)});
    return faults;
  }
  std::set<std::string> names;
  int in_shared_memory = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string at = fmt::format("/{}", i);
    checkOne(outputs[i], at, faults);
    if (!names.insert(outputs[i].shownName()).second) {
      faults.push_back({at, fmt::format("is the second output named \"{}\"; give it a \"name\"",
                                        outputs[i].shownName())});
    }
    in_shared_memory += outputs[i].kind == OutputKind::kSharedMemory ? 1 : 0;
    if (in_shared_memory == 2 && outputs[i].kind == OutputKind::kSharedMemory)
      faults.push_back({at, "is the second output of kind shared_memory; a wall has at most one"});
  }
  return faults;
}

}  // namespace merlin::render
