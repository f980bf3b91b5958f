// All findings of a configuration as text.
#pragma once

#include <string>

#include "config/loader.h"

namespace merlin::test {

// Returns one line for each finding, in the form in which merlind prints it for a file named
// "f.json".
inline std::string findingsOf(const LoadedSettings& loaded) {
  std::string text;
  for (const Finding& finding : loaded.findings) text += toText("f.json", finding) + "\n";
  return text;
}

}  // namespace merlin::test
