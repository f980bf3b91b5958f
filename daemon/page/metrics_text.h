// The metrics of both roles as text for Prometheus. Pure.
//
// Source: Prometheus, "Exposition formats", text format 0.0.4.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace merlin::page {

struct RoleMetrics {
  std::string role;      // "wall"
  bool running = false;  // whether the role runs
  std::string document;  // what it publishes as `metrics`, a flat JSON object; empty: nothing yet
};

struct PageMetrics {
  std::size_t connections = 0;
  std::uint64_t accepted = 0, sent_away = 0;  // connections; sent_away: refused or closed
  std::uint64_t requests = 0, refused = 0;    // requests; refused: answered by an error
  std::uint64_t pictures = 0;                 // encoded
};

// Returns a metric family with HELP and TYPE for each metric: merlin_wall_NAME, merlin_device_NAME
// with the label `device`, merlin_page_NAME, and merlin_up with the label `role`. Times are in
// seconds. A malformed document is left out. For a role that does not run, only merlin_up is
// written.
std::string metricsText(const std::vector<RoleMetrics>& roles, const PageMetrics& page);

// Whether metricsText() has a description for a metric of that role's document. For the tests.
bool isDescribed(const std::string& role, const std::string& name);

}  // namespace merlin::page
