// All findings of a configuration as text.
#pragma once

#include <string>

#include "config/loader.h"

namespace merlin::test {

// A line for each finding, as merlind prints it for the file "f.json".
inline std::string findingsOf(const LoadedSettings& loaded) {
  std::string text;
  for (const Finding& finding : loaded.findings) text += toText("f.json", finding) + "\n";
  return text;
}

}  // namespace merlin::test
