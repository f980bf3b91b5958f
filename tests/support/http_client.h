// HTTP requests made by hand, such as a browser, a program or a hostile client sends to the status
// page's server.
#pragma once

#include <algorithm>
#include <charconv>
#include <string>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "daemon/base/unique_fd.h"

namespace merlin::test {

// Connects to the page's server; the result is invalid if nothing listens at `port`. The receive
// buffer is small, so that the server soon notices a client that does not read.
inline UniqueFd connectToPage(int port) {
  UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int small = 4096;
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  const timeval limit{20, 0};
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  return fd;
}

inline void sendText(const UniqueFd& fd, const std::string& text) {
  (void)!::send(fd.get(), text.data(), text.size(), MSG_NOSIGNAL);
}

// Returns everything that the server sends until it closes the connection.
inline std::string receiveAll(const UniqueFd& fd) {
  std::string text;
  char buffer[8192];
  for (ssize_t n = 0; (n = ::recv(fd.get(), buffer, sizeof buffer, 0)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  return text;
}

struct HttpAnswer {
  int status = 0;  // 0: no answer came
  std::string head, body;
};

inline HttpAnswer parseAnswer(const std::string& text) {
  HttpAnswer answer;
  if (!text.starts_with("HTTP/1.1 ")) return answer;
  std::from_chars(text.data() + 9, text.data() + 12, answer.status);
  const std::size_t end = text.find("\r\n\r\n");
  answer.head = text.substr(0, end);
  if (end != std::string::npos) answer.body = text.substr(end + 4);
  return answer;
}

// A connection that is kept open for several requests, as browsers do.
class KeptConnection {
 public:
  explicit KeptConnection(int port) : fd_(connectToPage(port)) {}

  // Requests `path`; returns the status of the answer, or 0 if the connection is closed.
  int get(const std::string& path) {
    sendText(fd_, fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n", path));
    std::size_t head = 0;
    while ((head = received_.find("\r\n\r\n")) == std::string::npos) {
      if (!receive()) return 0;
    }
    const HttpAnswer answer = parseAnswer(received_.substr(0, head));
    const std::string key = "Content-Length: ";
    const std::size_t at = answer.head.find(key);
    std::size_t length = 0;
    if (at != std::string::npos) length = std::stoul(answer.head.substr(at + key.size()));
    while (received_.size() < head + 4 + length) {
      if (!receive()) return 0;
    }
    received_.erase(0, head + 4 + length);
    return answer.status;
  }

 private:
  bool receive() {
    char buffer[8192];
    const ssize_t n = ::recv(fd_.get(), buffer, sizeof buffer, 0);
    if (n > 0) received_.append(buffer, static_cast<std::size_t>(n));
    return n > 0;
  }

  UniqueFd fd_;
  std::string received_;
};

inline HttpAnswer askPage(int port, const std::string& request) {
  const UniqueFd fd = connectToPage(port);
  if (!fd.valid()) return {};
  sendText(fd, request);
  return parseAnswer(receiveAll(fd));
}

// `more`: further header lines, each with its line end.
inline std::string getRequest(const std::string& path, const std::string& more = "") {
  return fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n{}\r\n", path,
                     more);
}

inline std::string postRequest(const std::string& path, const std::string& token,
                               const std::string& body) {
  return fmt::format(
      "POST {} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\nAuthorization: Bearer {}\r\n"
      "Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}",
      path, token, body.size(), body);
}

}  // namespace merlin::test
