// PageServer: serves the operator's web page, with all documents and pictures, on its own thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/base/watched_thread.h"
#include "daemon/net/server_keeper.h"
#include "daemon/net/server_thread.h"
#include "daemon/page/event_log.h"
#include "daemon/page/frame_history.h"
#include "daemon/page/http_server.h"
#include "daemon/page/picture_maker.h"
#include "daemon/page/role_watch.h"
#include "daemon/page/routes.h"
#include "daemon/page/settings.h"
#include "daemon/page/thumbnails.h"
#include "daemon/status/command_queue.h"

namespace merlin::page {

struct PageServerSettings {
  PageSettings page;
  std::string instance;  // name of the instance of merlind whose wall it shows
  std::string version;   // of this program
  std::string token, token_file;
  std::vector<PageContent> contents;  // of the configuration
  std::string thumbnail_folder;       // where models' pictures are kept
};

// It is a client of the roles' shared memory and sockets. Owns its threads: one for all clients,
// one for pictures, one for thumbnails.
class PageServer final : public net::Server {
 public:
  // `events`, `watch` and `clock` must outlive the server. Errors: those of net::listenTcp() and
  // HttpServer::make().
  static Result<std::unique_ptr<PageServer>> start(PageServerSettings settings, EventLog& events,
                                                   ThreadWatch& watch, Clock& clock);
  ~PageServer() override;
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  int port() const noexcept { return port_; }
  net::ServerReport report() const override { return http_->report(); }
  std::string failure() const override { return thread_.failure(); }

 private:
  // A request that waits for a picture.
  struct WaitingPicture {
    PictureRoute route;
    Timestamp until{};  // then it is answered even without a newer picture
  };

  PageServer(PageServerSettings settings, EventLog& events, ThreadWatch& watch, Clock& clock);
  void round();
  void updateRoles(Timestamp now);
  std::optional<Answer> handle(const Request& request, std::uint64_t id);
  std::optional<Answer> execute(const CommandRoute& route, std::uint64_t id);
  Answer thumbnail(std::uint64_t content) const;
  Answer phone(const std::string& origin) const;
  std::optional<Answer> pictureFor(const PictureRoute& route);
  void answerPictures(Timestamp now);
  std::string status() const;
  std::string metrics() const;
  void noteRefusal(const Request& request, const Answer& answer);
  void tellRefusals(Timestamp now);

  PageServerSettings settings_;
  RouteSettings routes_;
  EventLog& events_;
  Clock& clock_;
  int port_ = 0;
  WallWatch wall_;
  DevicesWatch devices_;
  FrameHistory frames_;
  status::CommandQueue wall_commands_, devices_commands_;
  PictureMaker pictures_;
  Thumbnails thumbnails_;
  std::map<std::uint64_t, WaitingPicture> waiting_;
  Timestamp looked_{};  // when the roles were last looked at
  std::uint64_t refused_ = 0, told_refused_ = 0;
  std::string last_refusal_;
  Timestamp told_{};
  std::unique_ptr<HttpServer> http_;
  net::ServerThread thread_;  // uses everything above
};

}  // namespace merlin::page
