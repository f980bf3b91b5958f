// PageProcess: a real `merlind --role page` beside a Merlind, at a free port.
#pragma once

#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/net/connection_server.h"
#include "tests/support/http_client.h"
#include "tests/system/merlind.h"

namespace merlin::test {

inline int freePagePort() {
  const auto probe = net::listenTcp("127.0.0.1", 0);
  return probe ? net::portOf(probe->get()) : 0;
}

class PageProcess {
 public:
  // `config`: a configuration file in which /page/port is `port`.
  PageProcess(const TempDir& dir, const std::string& config, const std::string& instance, int port)
      : token_file_(dir / (instance + "-page.token")),
        port_(port),
        process_(std::make_unique<Process>(
            std::vector<std::string>{kMerlind, "--config", config, "--role", "page"})) {}

  bool ready() { return process_->saysEventually("ready"); }
  Process& process() { return *process_; }
  int port() const { return port_; }
  std::string token() const { return readText(token_file_).substr(0, 32); }

  HttpAnswer get(const std::string& path, const std::string& more = "") const {
    return askPage(port_, getRequest(path, more));
  }
  HttpAnswer send(const std::string& command, const std::string& argument = "") const {
    nlohmann::json body = {{"command", command}};
    if (!argument.empty()) body["argument"] = argument;
    return askPage(port_, postRequest("/api/command", token(), body.dump()));
  }
  // Returns the page's answer as JSON; is_discarded() is true for it if the answer is not JSON.
  nlohmann::json json(const std::string& path) const {
    return nlohmann::json::parse(get(path).body, nullptr, false);
  }
  bool runs(const std::string& role) const {
    const nlohmann::json status = json("/api/status");
    return status.is_object() && status["roles"][role]["running"] == true &&
           status["roles"][role]["status"].is_object();
  }

 private:
  std::string token_file_;
  int port_;
  std::unique_ptr<Process> process_;
};

}  // namespace merlin::test
