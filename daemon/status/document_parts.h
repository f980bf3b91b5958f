// Values that several documents write in the same way.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/base/fixed_text.h"
#include "daemon/shm/layout.h"

namespace merlin::status {

using OrderedJson = nlohmann::ordered_json;

// Writes a time, in nanoseconds since 1970 (UTC), as ISO 8601 to the microsecond:
// "2026-11-23T14:05:07.000250Z".
std::string isoUtc(std::int64_t utc_ns);
// Converts `now`, a time of CLOCK_MONOTONIC, by the clock offset in the segment's header, and
// writes it like isoUtc().
std::string timeUtc(const shm::Header& header, Timestamp now);

// Rounds to three decimals; 0 if not finite.
double round3(double value);

// Writes the document as JSON text. Replaces invalid UTF-8, which texts of devices may contain.
std::string dump(const OrderedJson& json);

template <std::size_t N>
std::string text(const char (&field)[N]) {
  return std::string(textIn(field));
}

// Returns the values as a JSON list, rounded to six decimals (a micrometre, a microradian), which
// is enough for measurements; 0 for a value that is not finite.
template <typename T>
OrderedJson list(std::span<const T> values) {
  OrderedJson json = OrderedJson::array();
  for (const T v : values) {
    const double wide = static_cast<double>(v);
    json.push_back(std::isfinite(wide) ? std::round(wide * 1e6) / 1e6 : 0);
  }
  return json;
}

template <typename T>
OrderedJson integers(std::span<const T> values) {
  OrderedJson json = OrderedJson::array();
  for (const T v : values) json.push_back(static_cast<int>(v));
  return json;
}

}  // namespace merlin::status
