#include "daemon/status/document_parts.h"

#include <ctime>

#include <fmt/format.h>

namespace merlin::status {

std::string isoUtc(std::int64_t utc_ns) {
  const std::int64_t us = utc_ns / 1000;
  const auto seconds = static_cast<std::time_t>(us / 1'000'000);
  std::tm tm{};
  ::gmtime_r(&seconds, &tm);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", tm.tm_year + 1900, tm.tm_mon + 1,
                     tm.tm_mday, tm.tm_hour, tm.tm_min, tm.tm_sec, us % 1'000'000);
}

std::string timeUtc(const shm::Header& header, Timestamp now) {
  return isoUtc(toNanoseconds(now) + header.realtime_offset_ns.load(std::memory_order_relaxed));
}

double round3(double value) { return std::isfinite(value) ? std::round(value * 1000) / 1000 : 0; }

std::string dump(const OrderedJson& json) {
  return json.dump(-1, ' ', false,
                   OrderedJson::error_handler_t::replace);  // device texts may be invalid UTF-8
}

}  // namespace merlin::status
