// KnownSecrets: the secrets that must not appear anywhere in a report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"

namespace merlin::cli {

// Replaces secrets in texts of other programs, such as a journal. The files with secrets, the
// settings that name them, and the token of the web page are left out of a report anyway. Only
// secrets that this user can read are known.
class KnownSecrets {
 public:
  // Reads the secret files that the settings name, and those of `others` that exist, as far as this
  // user may. The paths in the settings count as secrets too, because somebody may have entered a
  // secret instead of a path. So do arguments of alarms' programs of at least 12 characters,
  // because they may be tokens.
  KnownSecrets(const Settings& settings, const std::vector<std::string>& others);
  // Takes these texts as the secrets.
  explicit KnownSecrets(const std::vector<std::string>& texts);

  // Adds the secrets of further settings.
  void add(const Settings& settings);

  // Returns the text with each secret replaced by kSecretLeftOut. Cost: O(text x secrets).
  std::string without(std::string_view text) const;
  // Returns whether the text contains any of the secrets.
  bool isIn(std::string_view text) const;

 private:
  void add(std::string_view text);
  void addFile(const std::string& path);
  void sortByLength();

  std::vector<std::string> texts_;  // the longest first, because a secret may be a part of another
};

}  // namespace merlin::cli
