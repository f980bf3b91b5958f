// The secrets that a report must not have, wherever they stand.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/settings.h"

namespace merlin::cli {

// A report takes nothing that is secret by its meaning: neither the settings that name files with
// secrets nor these files nor the page's token. This is for what other programs have written down,
// such as a journal: where a secret that this user can read stands in a text, it is replaced.
class KnownSecrets {
 public:
  // Reads the files that the settings name, and `others` that exist, as far as this user may. The
  // name of a file that does not exist counts as a secret, since somebody may have written the
  // secret there. So does an argument of an alarm's program, from 12 characters on: it may be a
  // token.
  KnownSecrets(const Settings& settings, const std::vector<std::string>& others);
  explicit KnownSecrets(const std::vector<std::string>& texts);

  // Those of other settings too.
  void add(const Settings& settings);

  // The text with each secret replaced by kSecretLeftOut. O(text x secrets).
  std::string without(std::string_view text) const;
  bool isIn(std::string_view text) const;

 private:
  void add(std::string_view text);
  void addFile(const std::string& path);
  void sortByLength();

  std::vector<std::string> texts_;  // the longest first: one may be part of another
};

}  // namespace merlin::cli
