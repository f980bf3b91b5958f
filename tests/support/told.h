// told(): returns events as sentences, for comparison in a test: "fault: output left failed:
// unplugged".
#pragma once

#include <string>
#include <vector>

#include "daemon/base/event_kinds.h"

namespace merlin::test {

using Sentences = std::vector<std::string>;

inline Sentences told(const std::vector<Event>& events) {
  Sentences sentences;
  for (const Event& event : events)
    sentences.push_back((event.isFault() ? "fault: " : "") + event.what);
  return sentences;
}

}  // namespace merlin::test
