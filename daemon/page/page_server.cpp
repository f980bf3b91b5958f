#include "daemon/page/page_server.h"

#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/net/connection_server.h"
#include "daemon/page/documents.h"
#include "daemon/page/host_names.h"
#include "daemon/page/metrics_text.h"
#include "daemon/page/phone_address.h"
#include "daemon/page/qr_code.h"

namespace merlin::page {
namespace {

// Interval at which documents and answers of the roles are looked for, since they cannot be polled
// together with sockets.
constexpr Duration kLook = std::chrono::milliseconds(20);
constexpr Duration kCommandPatience = std::chrono::seconds(5);
constexpr Duration kPicturePatience = std::chrono::seconds(1);
constexpr Duration kTellAgain = std::chrono::seconds(5);

RouteSettings routeSettings(const PageServerSettings& s) {
  return {{s.token, wordsOf(s.page.host_names), isLoopback(s.page.address)},
          s.page.enabled,
          s.page.metrics};
}

// Returns the first number of this run's pictures. It is higher than all numbers of earlier runs,
// so that a number that a browser has from an earlier run is not used again.
std::uint64_t firstNumber() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1000 + 1;
}

rfb::View viewOf(const std::string& name) {
  if (name == "wall") return {};
  if (name == "operator") return {rfb::View::Kind::kOperator, ""};
  return {rfb::View::Kind::kTile, name.substr(std::string_view("tile ").size())};
}

Answer pictureAnswer(const MadePicture& picture) {
  Answer answer{200, "image/jpeg", picture.jpeg, {}};
  answer.headers.emplace_back("X-Picture-Number", std::to_string(picture.number));
  answer.headers.emplace_back("X-Picture-Size",
                              fmt::format("{} {}", picture.width, picture.height));
  if (const auto& at = picture.panel) {
    answer.headers.emplace_back(
        "X-Picture-Panel", fmt::format("{} {} {} {} {} {}", at->x, at->y, at->width, at->height,
                                       at->to_frame_x, at->to_frame_y));
  }
  return answer;
}

template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

Answer json(std::string text) { return Answer::text(200, "application/json", std::move(text)); }

}  // namespace

Result<std::unique_ptr<PageServer>> PageServer::start(PageServerSettings settings, EventLog& events,
                                                      ThreadWatch& watch, Clock& clock) {
  auto listener = net::listenTcp(settings.page.address, settings.page.port);
  if (!listener) return listener.error();
  const int port = net::portOf(listener->get());
  std::unique_ptr<PageServer> server(new PageServer(std::move(settings), events, watch, clock));
  server->port_ = port;
  auto http = HttpServer::make(
      *std::move(listener), {},
      [page = server.get()](const Request& request, std::uint64_t id) {
        return page->handle(request, id);
      },
      clock);
  if (!http) return http.error();
  server->http_ = *std::move(http);
  server->thread_ = net::ServerThread(watch, "page", [page = server.get()] { page->round(); });
  return server;
}

PageServer::PageServer(PageServerSettings settings, EventLog& events, ThreadWatch& watch,
                       Clock& clock)
    : settings_(std::move(settings)),
      routes_(routeSettings(settings_)),
      events_(events),
      clock_(clock),
      wall_(settings_.instance, "wall", events),
      devices_(settings_.instance, "devices", events),
      pictures_(settings_.instance, settings_.page.picture_hz, firstNumber(), watch, clock),
      thumbnails_(settings_.instance, settings_.contents,
                  {settings_.thumbnail_folder, settings_.instance + "-page-"}, firstNumber(), watch,
                  clock) {}

PageServer::~PageServer() { thread_.stop(); }

void PageServer::round() {
  const std::array<int, 1> wakers = {pictures_.fd()};
  http_->round(kLook, wakers);
  pictures_.clear();
  const Timestamp now = clock_.now();
  answerPictures(now);
  if (now - looked_ < kLook) return;
  looked_ = now;
  updateRoles(now);
  tellRefusals(now);
}

void PageServer::updateRoles(Timestamp now) {
  wall_.update(now);
  devices_.update(now);
  if (const shm::WallSegment* const wall = wall_.segment())
    frames_.follow(wall->trace, wall->header.generation);
  const auto answerer = [this](const std::string& role) {
    return [this, role](std::uint64_t id, const Result<std::string>& result) {
      const bool gone = !result && result.error().code == Errc::kNotFound;
      http_->answer(id, gone ? errorAnswer(503, fmt::format("the role {} does not run", role))
                             : commandAnswer(result));
    };
  };
  wall_commands_.update(wall_.commandEndpoint(), now, answerer(wall_.role()));
  devices_commands_.update(devices_.commandEndpoint(), now, answerer(devices_.role()));
}

std::optional<Answer> PageServer::handle(const Request& request, std::uint64_t id) {
  Route asked = route(request, routes_);
  const auto answer = std::visit(
      Overloaded{
          [](Answer& refused) -> std::optional<Answer> { return std::move(refused); },
          [](const FileRoute& r) -> std::optional<Answer> {
            Answer file =
                Answer::text(200, std::string(r.file->type), std::string(r.file->content));
            file.headers = {{"ETag", std::string(r.file->etag)}, {"Cache-Control", "no-cache"}};
            return file;
          },
          [&](const StatusRoute&) -> std::optional<Answer> { return json(status()); },
          [](const CommandListRoute&) -> std::optional<Answer> { return json(commandList()); },
          [&](const EventsRoute& r) -> std::optional<Answer> {
            return json(events_.since(r.since));
          },
          [&](const FramesRoute& r) -> std::optional<Answer> {
            return json(frames_.since(r.since));
          },
          [&](const MetricsRoute&) -> std::optional<Answer> {
            return Answer::text(200, "text/plain; version=0.0.4; charset=utf-8", metrics());
          },
          [&](const PictureRoute& r) -> std::optional<Answer> {
            if (auto now = pictureFor(r)) return now;
            waiting_[id] = {r, clock_.now() + kPicturePatience};
            return std::nullopt;
          },
          [&](const ContentsRoute&) -> std::optional<Answer> {
            return json(contentsDocument(thumbnails_.contents(), thumbnails_.shown()));
          },
          [&](const ThumbnailRoute& r) -> std::optional<Answer> { return thumbnail(r.content); },
          [&](const PhoneRoute& r) -> std::optional<Answer> { return phone(r.origin); },
          [&](const CommandRoute& r) -> std::optional<Answer> { return execute(r, id); }},
      asked);
  if (answer && answer->status >= 400) noteRefusal(request, *answer);
  return answer;
}

std::optional<Answer> PageServer::execute(const CommandRoute& route, std::uint64_t id) {
  status::CommandQueue& queue =
      route.command->role == CommandOf::kWall ? wall_commands_ : devices_commands_;
  if (queue.add(
          {id, std::string(route.command->name), route.argument, clock_.now() + kCommandPatience}))
    return std::nullopt;
  return errorAnswer(503, "too many commands wait; try again later");
}

Answer PageServer::thumbnail(std::uint64_t content) const {
  const auto jpeg = thumbnails_.jpeg(content);
  if (!jpeg) return errorAnswer(404, fmt::format("there is no picture of content {}", content));
  return {200, "image/jpeg", jpeg, {}};
}

Answer PageServer::phone(const std::string& origin) const {
  const auto address = phoneAddress(origin, {settings_.page.address, port_, networkAddresses()});
  if (!address) return json(phoneDocument({"", address.error().what, {}}));
  auto code = qrCode(*address + "#token=" + settings_.token);
  if (!code) return errorAnswer(500, code.error().what);
  return json(phoneDocument({*address, "", *std::move(code)}));
}

// Returns the answer, or nothing if the client has to wait for a newer picture.
std::optional<Answer> PageServer::pictureFor(const PictureRoute& route) {
  const auto picture = pictures_.newest({viewOf(route.view), route.width});
  if (!picture)
    return errorAnswer(
        503, fmt::format("{} other views and sizes are in use already", PictureMaker::kMostKinds));
  if (!picture->jpeg || picture->number == route.after) return std::nullopt;
  return pictureAnswer(*picture);
}

void PageServer::answerPictures(Timestamp now) {
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    auto answer = pictureFor(it->second.route);
    if (!answer && now >= it->second.until) answer = Answer{204, "", nullptr, {}};
    if (answer) http_->answer(it->first, *answer);
    it = answer ? waiting_.erase(it) : std::next(it);
  }
}

std::string PageServer::status() const {
  const Timestamp now = clock_.now();
  const auto stateOf = [now](const auto& role) {
    return RoleState{role.role(), role.isRunning(), role.status(),
                     role.status().empty() ? Duration{} : now - role.heard()};
  };
  return statusDocument(
      {settings_.instance, settings_.version, settings_.token_file, settings_.page.picture_hz},
      {stateOf(wall_), stateOf(devices_)});
}

std::string PageServer::metrics() const {
  const net::ServerReport report = http_->report();
  return metricsText({{wall_.role(), wall_.isRunning(), wall_.metrics()},
                      {devices_.role(), devices_.isRunning(), devices_.metrics()}},
                     {report.connections, report.accepted, report.sentAway(), http_->requests(),
                      refused_, pictures_.made()});
}

void PageServer::noteRefusal(const Request& request, const Answer& answer) {
  ++refused_;
  last_refusal_ = fmt::format("{} {}: status {}", oneLine(excerpt(request.method)),
                              oneLine(excerpt(request.path)), answer.status);
}

// Adds an event about newly refused requests, at most every five seconds.
void PageServer::tellRefusals(Timestamp now) {
  if (refused_ == told_refused_ || now - told_ < kTellAgain) return;
  const std::uint64_t fresh = refused_ - told_refused_;
  events_.add("page", "server",
              fmt::format("{} request{} refused; the last: {}", fresh,
                          fresh == 1 ? " was" : "s were", last_refusal_));
  told_refused_ = refused_;
  told_ = now;
}

}  // namespace merlin::page
