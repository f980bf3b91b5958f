// The secrets that must not appear anywhere in a report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"

namespace merlin::cli {

// A report includes neither the settings that name files with secrets, nor these files, nor the
// page's token. This class is for texts of other programs, such as a journal: it replaces every
// secret in them that this user can read.
class KnownSecrets {
 public:
  // Reads the secret files that the settings name, and those of `others` that exist, as far as this
  // user may. The name of a file that does not exist counts as a secret itself, since somebody may
  // have entered the secret instead of a name. So does an argument of an alarm's program with at
  // least 12 characters, since it may be a token.
  KnownSecrets(const Settings& settings, const std::vector<std::string>& others);
  explicit KnownSecrets(const std::vector<std::string>& texts);

  // Adds the secrets of other settings.
  void add(const Settings& settings);

  // The text with each secret replaced by kSecretLeftOut. O(text x secrets).
  std::string without(std::string_view text) const;
  bool isIn(std::string_view text) const;

 private:
  void add(std::string_view text);
  void addFile(const std::string& path);
  void sortByLength();

  std::vector<std::string> texts_;  // the longest first, since one may be part of another
};

}  // namespace merlin::cli
