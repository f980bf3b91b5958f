#include "daemon/reload/answer.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace merlin::reload {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongest = 200;  // bytes of a value, for a person

// Shortens a long text, but not in the middle of a UTF-8 character.
std::string cut(const std::string& text) {
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + " ...";
}

Json valuesOf(const std::vector<SettingChange>& changes) {
  Json list = Json::array();
  for (const SettingChange& change : changes) {
    list.push_back(
        {{"setting", change.pointer}, {"from", cut(change.before)}, {"to", cut(change.after)}});
  }
  return list;
}

// Returns the pointers of the settings without their values, which may name files with secrets.
Json pointersOf(const std::vector<SettingChange>& changes) {
  Json list = Json::array();
  for (const SettingChange& change : changes) list.push_back(change.pointer);
  return list;
}

Json asideOf(const std::vector<AsideAlignment>& alignments) {
  Json list = Json::array();
  for (const AsideAlignment& a : alignments) list.push_back({{"output", a.output}, {"why", a.why}});
  return list;
}

// Returns the first of `count` texts, followed by the number of the others.
std::string firstOf(const std::string& first, std::size_t count) {
  return count > 1 ? fmt::format("{} (and {} more)", first, count - 1) : first;
}

}  // namespace

std::string restartReason(const Plan& plan) {
  return firstOf(plan.restart.front().pointer, plan.restart.size());
}

std::string answerText(const Answer& answer) {
  const Json json{{"outcome", kOutcomeNames[static_cast<std::size_t>(answer.outcome)]},
                  {"only_checked", answer.only_checked},
                  {"file", answer.file},
                  {"findings", answer.findings},
                  {"swapped", valuesOf(answer.plan.swapped)},
                  {"restart", pointersOf(answer.plan.restart)},
                  {"elsewhere", pointersOf(answer.plan.elsewhere)},
                  {"set_aside", asideOf(answer.set_aside)},
                  {"brought_back", answer.brought_back},
                  {"failure", answer.failure}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string refusal(const Answer& answer) {
  constexpr const char* kKept = "the previous settings stay in effect";
  switch (answer.outcome) {
    case Outcome::kDone:
    case Outcome::kRestarts: return {};
    case Outcome::kInvalid:
      return fmt::format("{}; {}", firstOf(answer.findings.front(), answer.findings.size()), kKept);
    case Outcome::kFailed: break;
  }
  return fmt::format("{}: {}; {}", answer.file, answer.failure, kKept);
}

}  // namespace merlin::reload
