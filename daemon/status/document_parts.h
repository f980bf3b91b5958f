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

// ISO 8601, to the microsecond: "2026-11-23T14:05:07.000250Z".
std::string isoUtc(std::int64_t utc_ns);
// isoUtc() of `now`, a time of CLOCK_MONOTONIC, with the clock offset in the segment's header.
std::string timeUtc(const shm::Header& header, Timestamp now);

// Rounds to three decimals; 0 if not finite.
double round3(double value);

// The document as text. Texts of devices may be invalid UTF-8, which is replaced.
std::string dump(const OrderedJson& json);

template <std::size_t N>
std::string text(const char (&field)[N]) {
  return std::string(textIn(field));
}

// Rounds to six decimals (a micrometre, a microradian), enough for measurements.
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
