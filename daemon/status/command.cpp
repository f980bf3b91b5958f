#include "daemon/status/command.h"

#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace merlin::status {
namespace {

Result<std::string> runWith(const Command& command, const nlohmann::json& request) {
  const auto argument = request.find("argument");
  if (argument != request.end() && argument->is_string())
    return command.run_with(argument->get<std::string>());
  return Error{Errc::kInvalidArgument,
               fmt::format("{} needs an \"argument\", a text: {}", command.name, command.help)};
}

}  // namespace

std::string failure(std::string_view what) {
  using Json = nlohmann::ordered_json;
  return Json{{"ok", false}, {"error", std::string(what)}}.dump(-1, ' ', false,
                                                                Json::error_handler_t::replace);
}

std::string answerTo(std::string_view request, std::span<const Command> commands) {
  const auto json = nlohmann::json::parse(request, nullptr, false);
  const auto name = json.is_object() ? json.find("command") : json.end();
  std::vector<std::string> names;
  for (const Command& c : commands) names.push_back(c.name);
  if (!json.is_object() || name == json.end() || !name->is_string()) {
    return failure(R"(a request is {"command": "NAME"}, NAME one of )" +
                   fmt::format("{}", fmt::join(names, ", ")));
  }
  for (const Command& c : commands) {
    if (*name != c.name) continue;
    const auto result = c.run_with ? runWith(c, json) : c.run();
    return result ? fmt::format(R"({{"ok": true, "result": {}}})", *result)
                  : failure(result.error().what);
  }
  return failure(fmt::format("\"{}\" is not a known command; commands are {}",
                             name->get<std::string>().substr(0, 64), fmt::join(names, ", ")));
}

}  // namespace merlin::status
