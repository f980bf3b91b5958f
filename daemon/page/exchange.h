// An HTTP request and its answer as plain data, independent of the HTTP library.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace merlin::page {

// Limits of a request; the server refuses what is larger, without keeping it.
inline constexpr std::size_t kMostBodyBytes = 4096;
inline constexpr std::size_t kMostQueries = 8;

struct Request {
  std::string method;                        // "GET"
  std::string path;                          // "/api/status", decoded, without the query
  std::map<std::string, std::string> query;  // decoded
  // The headers in kKeptHeaders, by their name in lower case. If one of them was sent twice, the
  // first value is kept and `repeated` is set.
  std::map<std::string, std::string> headers;
  bool repeated = false;
  std::string body;
  bool passed_on = false;  // the request has one of kProxyHeaders

  // Returns the value of a kept header, by its name in lower case; empty if the request lacks it.
  const std::string& header(const std::string& name) const {
    static const std::string kNone;
    const auto found = headers.find(name);
    return found == headers.end() ? kNone : found->second;
  }
};

// The headers that a Request keeps.
inline constexpr const char* kKeptHeaders[] = {"host",           "origin",        "sec-fetch-site",
                                               "sec-fetch-mode", "authorization", "content-type",
                                               "if-none-match",  "accept"};

// Headers by which a proxy says that it passes on the request of another machine. One of them is
// enough, whatever its value.
inline constexpr const char* kProxyHeaders[] = {
    "forwarded", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto", "x-real-ip", "via"};

struct Answer {
  unsigned status = 200;
  std::string type = "application/json";
  std::shared_ptr<const std::string> body;  // shared with other answers, such as a picture
  std::vector<std::pair<std::string, std::string>> headers;

  static Answer text(unsigned status, std::string type, std::string body) {
    return {status, std::move(type), std::make_shared<const std::string>(std::move(body)), {}};
  }
};

}  // namespace merlin::page
