#include "daemon/cli/report/known_secrets.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "config/effective.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

constexpr std::size_t kShortest = 4;  // shorter texts occur by chance in any text
// Shorter arguments are probably options or names, not tokens.
constexpr std::size_t kShortestArgument = 12;
constexpr std::size_t kMostFileBytes = 65536;

}  // namespace

KnownSecrets::KnownSecrets(const Settings& settings, const std::vector<std::string>& others) {
  for (const std::string& path : others) {
    if (fileStamp(path)) addFile(path);
  }
  add(settings);
}

void KnownSecrets::add(const Settings& settings) {
  for (const std::string& path : secretFilesOf(settings)) {
    add(path);
    addFile(path);
  }
  for (const AlarmSettings& alarm : settings.alarms) {
    for (std::size_t i = 1; i < alarm.run.size(); ++i) {
      if (alarm.run[i].size() >= kShortestArgument) add(alarm.run[i]);
    }
  }
  sortByLength();
}

KnownSecrets::KnownSecrets(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) add(text);
  sortByLength();
}

// Adds the text as a secret, and also its forms in JSON and in messages, in which some characters
// are escaped.
void KnownSecrets::add(std::string_view text) {
  if (text.size() < kShortest) return;
  texts_.emplace_back(text);
  const std::string json = jsonText(nlohmann::json(text));
  for (const std::string& escaped : {json.substr(1, json.size() - 2), oneLine(text)}) {
    if (escaped != text) texts_.push_back(escaped);
  }
}

// Adds each line of the file as a whole, for passwords and tokens, and its last word, for "secret
// KEY". A line "public KEY" is not a secret. If the file does not exist, adds its name.
void KnownSecrets::addFile(const std::string& path) {
  const auto file = FileCopy::read(path, kMostFileBytes);
  if (!file && file.error().code == Errc::kNotFound)
    return add(std::filesystem::path(path).filename().string());
  if (!file) return;
  std::istringstream lines{std::string(file->text())};
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with("public ")) continue;
    add(line);
    if (const std::size_t blank = line.rfind(' '); blank != std::string::npos)
      add(std::string_view(line).substr(blank + 1));
  }
}

void KnownSecrets::sortByLength() {
  std::stable_sort(texts_.begin(), texts_.end(),
                   [](const std::string& a, const std::string& b) { return a.size() > b.size(); });
}

std::string KnownSecrets::without(std::string_view text) const {
  std::string out(text);
  for (const std::string& secret : texts_) {
    for (std::size_t at = out.find(secret); at != std::string::npos;) {
      out.replace(at, secret.size(), kSecretLeftOut);
      at = out.find(secret, at + std::string_view(kSecretLeftOut).size());
    }
  }
  return out;
}

bool KnownSecrets::isIn(std::string_view text) const {
  return std::any_of(texts_.begin(), texts_.end(), [&](const std::string& secret) {
    return text.find(secret) != std::string_view::npos;
  });
}

}  // namespace merlin::cli
