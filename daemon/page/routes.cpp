#include "daemon/page/routes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/printable_text.h"
#include "daemon/json/json_tree.h"

namespace merlin::page {
namespace {

// Commands with an argument that the page has controls for.
constexpr std::string_view kControls[] = {"triangles", "rate", "align",           "testcard",
                                          "move",      "show", "operator_pointer"};

constexpr std::size_t kLongestView = 64;

bool isReading(const Request& request) {
  return request.method == "GET" || request.method == "HEAD";
}

Answer wrongMethod(const char* allowed) {
  Answer answer =
      errorAnswer(405, fmt::format("the method is not allowed here; allowed: {}", allowed));
  answer.headers.emplace_back("Allow", allowed);
  return answer;
}

// Returns the number of a parameter of the query; 0 if it is absent; nothing if it is not a number.
std::optional<std::uint64_t> numberOf(const Request& request, const char* name) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return 0;
  const std::string& text = found->second;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

Answer badNumber(const char* name) {
  return errorAnswer(400, fmt::format("{} is not a whole number from 0 on", name));
}

template <typename Since>
Route sinceRoute(const Request& request) {
  const auto since = numberOf(request, "since");
  if (!since) return badNumber("since");
  return Since{*since};
}

Route pictureRoute(const Request& request) {
  PictureRoute picture;
  if (const auto view = request.query.find("view"); view != request.query.end())
    picture.view = view->second;
  const bool known = picture.view == "wall" || picture.view == "operator" ||
                     (picture.view.starts_with("tile ") && picture.view.size() > 5);
  if (!known || picture.view.size() > kLongestView || !isText(picture.view))
    return errorAnswer(400, fmt::format("view is \"{}\"; allowed are wall, operator, tile NAME",
                                        excerpt(picture.view)));
  const auto after = numberOf(request, "after"), width = numberOf(request, "width");
  if (!after) return badNumber("after");
  if (!width) return badNumber("width");
  picture.after = *after;
  if (*width == 0) return picture;
  const auto* const found = std::ranges::find_if(
      kPictureWidths, [&](int w) { return static_cast<std::uint64_t>(w) == *width; });
  if (found == std::end(kPictureWidths)) {
    return errorAnswer(
        400, fmt::format("width is {}; allowed are {}", *width, fmt::join(kPictureWidths, ", ")));
  }
  picture.width = *found;
  return picture;
}

Route thumbnailRoute(const Request& request) {
  const auto content = numberOf(request, "content");
  if (!content) return badNumber("content");
  return ThumbnailRoute{*content};
}

const JsonNode* memberOf(const JsonNode& object, std::string_view key) {
  const auto found =
      std::ranges::find_if(object.members, [&](const JsonNode::Member& m) { return m.key == key; });
  return found == object.members.end() ? nullptr : &found->value;
}

// Reads the request's content: {"command": NAME, "argument": TEXT}, with the argument only if the
// command needs one.
Route commandRoute(const Request& request) {
  constexpr const char* kForm =
      "the content must be {\"command\": \"NAME\", \"argument\": \"TEXT\"}";
  if (!request.header("content-type").starts_with("application/json"))
    return errorAnswer(415, "the content's type must be application/json");
  const auto parsed = parseJson(request.body);
  if (!parsed) return errorAnswer(400, fmt::format("{}; {}", parsed.error().what, kForm));
  const JsonNode* const name = memberOf(*parsed, "command");
  const JsonNode* const argument = memberOf(*parsed, "argument");
  if (!name || name->kind != JsonNode::Kind::kString ||
      (argument && argument->kind != JsonNode::Kind::kString) ||
      parsed->members.size() != (argument ? 2U : 1U))
    return errorAnswer(400, kForm);
  const CommandInfo* const command = findCommand(name->text);
  if (!command || !isPageCommand(*command)) {
    return errorAnswer(400, fmt::format("\"{}\" is not a command of the page; /api/commands lists "
                                        "them",
                                        excerpt(name->text)));
  }
  const std::string given = argument ? argument->text : "";
  if (command->argument.empty() && !given.empty())
    return errorAnswer(400, fmt::format("{} takes no argument", command->name));
  if (!command->argument.empty() && given.empty()) {
    return errorAnswer(400,
                       fmt::format("{} needs an argument: {}", command->name, command->argument));
  }
  if (!isText(given)) return errorAnswer(400, "the argument has control characters");
  return CommandRoute{command, given};
}

struct Path {
  std::string_view path;
  Needs needs;
  Route (*find)(const Request&);
};
constexpr Path kPaths[] = {
    {"/api/status", Needs::kReading, [](const Request&) -> Route { return StatusRoute{}; }},
    {"/api/commands", Needs::kReading, [](const Request&) -> Route { return CommandListRoute{}; }},
    {"/api/events", Needs::kReading, sinceRoute<EventsRoute>},
    {"/api/frames", Needs::kReading, sinceRoute<FramesRoute>},
    {"/picture.jpg", Needs::kReading, pictureRoute},
    {"/api/contents", Needs::kReading, [](const Request&) -> Route { return ContentsRoute{}; }},
    {"/thumbnail.jpg", Needs::kReading, thumbnailRoute},
    {"/api/command", Needs::kCommand, commandRoute},
    {"/api/phone", Needs::kCommand,
     [](const Request& request) -> Route { return PhoneRoute{request.header("origin")}; }},
    // Answers whether the token is accepted.
    {"/api/token", Needs::kCommand,
     [](const Request&) -> Route {
       return Answer::text(200, "application/json", "{\"ok\":true}\n");
     }},
};

Route fileRoute(const Request& request, const PageFile& file) {
  if (request.header("if-none-match") == file.etag) return Answer{304, "", nullptr, {}};
  return FileRoute{&file};
}

// Checks the request's method and token, and returns the route of an existing path.
Route checked(const Request& request, const RouteSettings& settings, const Path& path) {
  const bool reads = path.needs != Needs::kCommand;
  if (reads ? !isReading(request) : request.method != "POST")
    return wrongMethod(reads ? "GET, HEAD" : "POST");
  if (auto refused = refuse(request, path.needs, settings.gate)) return *std::move(refused);
  return path.find(request);
}

}  // namespace

bool isPageCommand(const CommandInfo& command) {
  if (command.bindable == Bindable::kHeld) return false;
  return command.by_name || command.bindable == Bindable::kOnce ||
         std::ranges::find(kControls, command.name) != std::end(kControls);
}

Route route(const Request& request, const RouteSettings& settings) {
  if (settings.metrics && request.path == "/metrics") {
    return checked(request, settings, {"/metrics", Needs::kReading, [](const Request&) -> Route {
                                         return MetricsRoute{};
                                       }});
  }
  if (settings.page) {
    for (const Path& path : kPaths) {
      if (path.path == request.path) return checked(request, settings, path);
    }
    if (const PageFile* const file = findPageFile(request.path)) {
      if (!isReading(request)) return wrongMethod("GET, HEAD");
      if (auto refused = refuse(request, Needs::kNothing, settings.gate))
        return *std::move(refused);
      return fileRoute(request, *file);
    }
  }
  if (auto refused = refuse(request, Needs::kNothing, settings.gate)) return *std::move(refused);
  return errorAnswer(404, "there is nothing here");
}

}  // namespace merlin::page
