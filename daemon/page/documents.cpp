#include "daemon/page/documents.h"

#include <fmt/format.h>

#include "daemon/base/commands.h"
#include "daemon/json/json_tree.h"
#include "daemon/page/gate.h"
#include "daemon/page/routes.h"
#include "render/testcard/card.h"

namespace merlin::page {
namespace {

const char* roleName(CommandOf role) {
  return role == CommandOf::kWall ? "wall" : role == CommandOf::kPanel ? "panel" : "devices";
}

std::string cardNames() {
  std::string names;
  for (const char* const name : render::testcard::kCardNames)
    names += (names.empty() ? "" : ",") + jsonText(name);
  return names;
}

}  // namespace

std::string statusDocument(const PageState& page, const std::vector<RoleState>& roles) {
  std::string list;
  for (const RoleState& r : roles) {
    list += fmt::format(R"({}{}:{{"running":{},"age_s":{:.1f},"status":{}}})",
                        list.empty() ? "" : ",", jsonText(r.role), r.running, toSeconds(r.age),
                        r.running && !r.status.empty() ? r.status : "null");
  }
  return fmt::format(
      R"({{"page":{{"instance":{},"version":{},"token_file":{},"picture_hz":{}}},"roles":{{{}}}}})"
      "\n",
      jsonText(page.instance), jsonText(page.version), jsonText(page.token_file), page.picture_hz,
      list);
}

std::string contentsDocument(const std::vector<ContentState>& contents,
                             const std::vector<ShownState>& shown) {
  std::string list, shown_list;
  for (const ContentState& c : contents) {
    list += fmt::format(R"({}{{"name":{},"kind":{},"thumbnail":{},"fault":{}}})",
                        list.empty() ? "" : ",", jsonText(c.name), jsonText(c.kind),
                        c.thumbnail > 0 ? std::to_string(c.thumbnail) : "null", jsonText(c.fault));
  }
  for (const ShownState& s : shown) {
    shown_list +=
        fmt::format(R"({}{{"name":{},"thumbnail":{},"place":{}}})", shown_list.empty() ? "" : ",",
                    jsonText(s.name), s.thumbnail, s.place);
  }
  return fmt::format("{{\"contents\":[{}],\"shown\":[{}]}}\n", list, shown_list);
}

std::string phoneDocument(const PhoneState& phone) {
  std::string rows;
  for (int y = 0; y < phone.code.side; ++y) {
    std::string row;
    for (int x = 0; x < phone.code.side; ++x) row += phone.code.isDark(x, y) ? '1' : '0';
    rows += fmt::format("{}\"{}\"", rows.empty() ? "" : ",", row);
  }
  return fmt::format("{{\"address\":{},\"why\":{},\"rows\":[{}]}}\n",
                     phone.address.empty() ? "null" : jsonText(phone.address), jsonText(phone.why),
                     rows);
}

std::string commandList() {
  std::string list;
  for (const CommandInfo& c : kCommands) {
    if (!isPageCommand(c)) continue;
    list += fmt::format(
        R"({}{{"name":{},"role":"{}","argument":{},"help":{},"button":{},"choices":[{}]}})",
        list.empty() ? "" : ",", jsonText(c.name), roleName(c.role), jsonText(c.argument),
        jsonText(c.help), c.argument.empty(), c.name == "testcard" ? cardNames() : "");
  }
  return fmt::format("{{\"commands\":[{}]}}\n", list);
}

Answer commandAnswer(const Result<std::string>& result) {
  if (result)
    return Answer::text(200, "application/json",
                        fmt::format("{{\"ok\":true,\"result\":{}}}\n", *result));
  const Errc code = result.error().code;
  const unsigned status = code == Errc::kInvalidArgument ? 400 : code == Errc::kTimeout ? 504 : 503;
  return Answer::text(
      status, "application/json",
      fmt::format("{{\"ok\":false,\"error\":{}}}\n", jsonText(result.error().what)));
}

}  // namespace merlin::page
