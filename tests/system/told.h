// Reads the events that an alarm's program has received and written into a file.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/temp_dir.h"

namespace merlin::test {

// Returns one JSON document for each start of the program, that is, for each line of the file.
inline std::vector<nlohmann::json> told(const std::string& file) {
  std::vector<nlohmann::json> all;
  std::istringstream lines(readText(file));
  for (std::string line; std::getline(lines, line);)
    all.push_back(nlohmann::json::parse(line, nullptr, false));
  return all;
}

}  // namespace merlin::test
