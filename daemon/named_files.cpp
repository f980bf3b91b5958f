#include "daemon/named_files.h"

#include <functional>
#include <string_view>

#include <fmt/format.h>

#include "daemon/base/files.h"

namespace merlin {
namespace {

std::size_t contentsOf(const std::string& name) {
  const std::hash<std::string_view> hash;
  const auto file = FileCopy::read(name);
  return file ? hash(file->text()) : hash(file.error().what);
}

}  // namespace

NamedFiles readNamedFiles(const Settings& settings) {
  const ServeSettings& s = settings.serve;
  const std::pair<const char*, const std::string*> named[] = {
      {"/postures/file", &settings.devices.postures},
      {"/gestures/file", &settings.devices.gestures},
      {"/serve/samples_keys", &s.samples_keys},
      {"/serve/samples_clients", &s.samples_clients},
      {"/serve/commands_keys", &s.commands_keys},
      {"/serve/commands_clients", &s.commands_clients},
      {"/serve/commands_readers", &s.commands_readers},
      {"/wall/input/keys", &settings.wall.input.keys}};
  NamedFiles files;
  for (const auto& [pointer, name] : named) {
    if (!name->empty()) files[pointer] = {*name, contentsOf(*name)};
  }
  return files;
}

std::vector<SettingChange> changesBetween(const NamedFiles& before, const NamedFiles& after) {
  std::vector<SettingChange> changes;
  for (const auto& [pointer, file] : after) {
    const auto was = before.find(pointer);
    if (was == before.end() || was->second.name != file.name || was->second == file) continue;
    const std::string name = fmt::format("\"{}\"", file.name);
    changes.push_back({pointer, name, name + " with other contents"});
  }
  return changes;
}

}  // namespace merlin
