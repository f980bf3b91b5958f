#include "drivers/pjlink/protocol.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "drivers/pjlink/digest.h"

namespace merlin::pjlink {
namespace {

constexpr char kEnd = '\r';
constexpr std::size_t kMostRandom = 32;

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

// Ignores case, because some projectors answer in lower case.
bool beginsWith(std::string_view line, std::string_view prefix) {
  return line.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), line.begin(),
                    [](char a, char b) { return upper(a) == upper(b); });
}

bool equals(std::string_view a, std::string_view b) {
  return a.size() == b.size() && beginsWith(a, b);
}

std::string shown(std::string_view line) { return oneLine(excerpt(line)); }

Answer answerOf(std::string_view value) {
  constexpr std::pair<std::string_view, Answer::Code> kErrors[] = {
      {"ERR1", Answer::Code::kUndefined},
      {"ERR2", Answer::Code::kOutOfRange},
      {"ERR3", Answer::Code::kUnavailable},
      {"ERR4", Answer::Code::kFailure}};
  for (const auto& [text, code] : kErrors) {
    if (equals(value, text)) return {code, std::string(text)};
  }
  return {Answer::Code::kValue, std::string(value)};
}

}  // namespace

std::string commandText(Command command, std::string_view input) {
  switch (command) {
    case Command::kPowerOn: return "%1POWR 1";
    case Command::kPowerOff: return "%1POWR 0";
    case Command::kInput: return fmt::format("%1INPT {}", input);
    case Command::kAskPower: return "%1POWR ?";
    case Command::kAskErrors: return "%1ERST ?";
    case Command::kAskLamps: return "%1LAMP ?";
    case Command::kAskName: return "%1NAME ?";
  }
  return {};
}

const char* errorText(Answer::Code code) {
  switch (code) {
    case Answer::Code::kUndefined: return "ERR1, it does not know the command";
    case Answer::Code::kOutOfRange: return "ERR2, it does not know the parameter";
    case Answer::Code::kUnavailable: return "ERR3, not available at this time";
    case Answer::Code::kFailure: return "ERR4, the projector has failed";
    case Answer::Code::kValue: break;
  }
  return "";
}

std::string Session::request(Command command, std::string_view input) {
  const std::string text = commandText(command, input);
  expected_ = text.substr(0, text.find(' ')) + "=";
  return std::exchange(digest_, {}) + text + kEnd;
}

Result<std::optional<Answer>> Session::feed(std::string_view bytes) {
  std::optional<Answer> answer;
  for (const char c : bytes) {
    if (c == '\n' && line_.empty()) continue;  // some projectors end lines with CR LF
    if (c != kEnd) {
      line_ += c;
      if (line_.size() < kMostLine) continue;
      return Error{Errc::kMalformed, fmt::format("sends a line of more than {} bytes, \"{}\"",
                                                 kMostLine, shown(line_))};
    }
    auto taken = take(std::exchange(line_, {}));
    if (!taken) return taken;
    if (*taken) answer = *std::move(taken);
  }
  return answer;
}

Result<std::optional<Answer>> Session::take(std::string_view line) {
  if (equals(line, "PJLINK ERRA"))
    return Error{Errc::kInvalidArgument, "refuses the password (ERRA)"};
  if (!open_) {
    if (const auto greeted = greet(line); !greeted) return greeted.error();
    return std::optional<Answer>();
  }
  if (expected_.empty())
    return Error{Errc::kMalformed, fmt::format("sends \"{}\" without being asked", shown(line))};
  if (!beginsWith(line, expected_)) {
    return Error{Errc::kMalformed,
                 fmt::format("answers \"{}\" where {}... was due", shown(line), expected_)};
  }
  line.remove_prefix(std::exchange(expected_, {}).size());
  return std::optional(answerOf(line));
}

Result<Ok> Session::greet(std::string_view line) {
  constexpr std::string_view kAuthenticated = "PJLINK 1 ";
  open_ = true;
  if (equals(line, "PJLINK 0")) return Ok{};
  const std::string_view random =
      beginsWith(line, kAuthenticated) ? line.substr(kAuthenticated.size()) : "";
  const bool good = !random.empty() && random.size() <= kMostRandom &&
                    std::ranges::all_of(random, [](char c) { return c > ' ' && c <= '~'; });
  if (!good) {
    return Error{Errc::kMalformed,
                 fmt::format("greets with \"{}\", which is not PJLink", shown(line))};
  }
  if (password_.empty()) {
    return Error{Errc::kInvalidArgument,
                 "asks for a password; name a file that contains it as password_file"};
  }
  digest_ = md5Hex(std::string(random) + password_);
  return Ok{};
}

}  // namespace merlin::pjlink
