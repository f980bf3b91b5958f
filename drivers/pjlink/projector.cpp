#include "drivers/pjlink/projector.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"

namespace merlin::pjlink {
namespace {

using std::chrono::seconds;

constexpr Duration kPoll = seconds(10);        // period of the power queries at rest
constexpr Duration kPollBusy = seconds(2);     // period while the power changes or is to change
constexpr Duration kRepeat = seconds(10);      // time until a command without effect is repeated
constexpr Duration kUnavailable = seconds(3);  // time until a command is repeated after ERR3
constexpr Duration kReconnect = seconds(5);
constexpr Duration kPasswordRetry = seconds(30);
constexpr Duration kErrorPeriod = seconds(30);
constexpr Duration kLamps = std::chrono::minutes(5);
constexpr std::size_t kMostLamps = 8;

std::optional<Power> parsePower(std::string_view value) {
  if (value.size() != 1) return std::nullopt;
  switch (value[0]) {
    case '0': return Power::kOff;
    case '1': return Power::kOn;
    case '2': return Power::kCooling;
    case '3': return Power::kWarming;
    default: return std::nullopt;
  }
}

// Parses "1234 1 900 0": for each lamp, its hours and whether it is lit. Empty if the text is not
// such a list.
std::vector<int> parseLamps(std::string_view text) {
  std::vector<int> hours;
  while (!text.empty() && hours.size() < kMostLamps) {
    const std::size_t space = text.find(' ');
    if (space == 0 || space > 5 || text.size() < space + 2) return {};
    int value = 0;
    const char* const end = text.data() + space;
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const char lit = text[space + 1];
    if (error != std::errc() || stop != end || value < 0 || (lit != '0' && lit != '1')) return {};
    hours.push_back(value);
    text.remove_prefix(space + 2);
    if (text.starts_with(' ')) text.remove_prefix(1);
  }
  return text.empty() ? hours : std::vector<int>();
}

bool isTransition(Power power) { return power == Power::kWarming || power == Power::kCooling; }

}  // namespace

const char* powerName(Power power) {
  switch (power) {
    case Power::kUnknown: return "unknown";
    case Power::kOff: return "off";
    case Power::kWarming: return "warming";
    case Power::kOn: return "on";
    case Power::kCooling: return "cooling";
  }
  return "unknown";
}

const char* healthName(Health health) {
  switch (health) {
    case Health::kOpening: return "opening";
    case Health::kOk: return "ok";
    case Health::kUnreachable: return "unreachable";
    case Health::kPassword: return "wrong_password";
    case Health::kRefused: return "refused";
    case Health::kFailed: return "failed";
  }
  return "failed";
}

Projector::Projector(const PjlinkSettings& settings, Timestamp now)
    : settings_(settings),
      quiet_until_(now),
      power_due_(now),
      switch_due_(now),
      input_due_(now),
      errors_due_(now),
      lamps_due_(now),
      name_due_(now),
      deadline_(now) {}

void Projector::want(bool on, Timestamp now) {
  wanted_ = on;
  input_wanted_ = on && !settings_.input.empty();
  refusal_.clear();
  input_refusal_.clear();
  quiet_until_ = power_due_ = switch_due_ = input_due_ = now;
  const bool first_the_other =
      power_ == Power::kUnknown || power_ == (on ? Power::kCooling : Power::kWarming);
  const double own_s = on ? settings_.warm_up_s : settings_.cool_down_s;
  const double other_s = on ? settings_.cool_down_s : settings_.warm_up_s;
  deadline_ = now + fromSeconds(own_s + (first_the_other ? other_s : 0));
}

std::optional<Command> Projector::switching() const {
  if (wanted_ == true && power_ == Power::kOff) return Command::kPowerOn;
  if (wanted_ == false && power_ == Power::kOn) return Command::kPowerOff;
  return std::nullopt;
}

std::optional<Command> Projector::next(Timestamp now) const {
  if (now < quiet_until_) return std::nullopt;
  if (now >= power_due_) return Command::kAskPower;
  if (const auto command = switching(); command && now >= switch_due_) return command;
  if (input_wanted_ && power_ == Power::kOn && now >= input_due_) return Command::kInput;
  if (now >= errors_due_) return Command::kAskErrors;
  if (now >= lamps_due_ && asks_for_lamps_) return Command::kAskLamps;
  if (now >= name_due_) return Command::kAskName;
  return std::nullopt;
}

Timestamp Projector::due() const {
  Timestamp due = std::min({power_due_, errors_due_, name_due_});
  if (asks_for_lamps_) due = std::min(due, lamps_due_);
  if (switching()) due = std::min(due, switch_due_);
  if (input_wanted_ && power_ == Power::kOn) due = std::min(due, input_due_);
  return std::max(due, quiet_until_);
}

void Projector::answered(Command command, const Answer& answer, Timestamp now) {
  asked_ = true;
  trouble_.reset();
  trouble_reason_.clear();
  switch (command) {
    case Command::kAskPower: return power(answer, now);
    case Command::kPowerOn:
    case Command::kPowerOff: return switched(command, answer, now);
    case Command::kInput: return inputSelected(answer, now);
    case Command::kAskErrors: errors_due_ = now + kErrorPeriod; return errors(answer);
    case Command::kAskLamps: lamps_due_ = now + kLamps; return lamps(answer);
    case Command::kAskName:
      name_due_ = Timestamp::max();
      if (answer.code == Answer::Code::kValue) identity_ = oneLine(excerpt(answer.value));
      return;
  }
}

// Right after it has accepted a switching to the opposite state, a projector may still report the
// old state for some seconds; that does not count as reached.
bool Projector::isReached(Timestamp now) const {
  const bool becomes_other = accepted_ && accepted_ != wanted_ && now - accepted_at_ < kRepeat;
  return wanted_ && !becomes_other && power_ == (*wanted_ ? Power::kOn : Power::kOff);
}

void Projector::power(const Answer& answer, Timestamp now) {
  const auto said = answer.code == Answer::Code::kValue ? parsePower(answer.value) : std::nullopt;
  power_ = said.value_or(Power::kUnknown);
  power_fault_.clear();
  if (!said) {
    power_fault_ = fmt::format("does not say whether it is on ({})",
                               answer.code == Answer::Code::kValue
                                   ? fmt::format("\"{}\"", oneLine(excerpt(answer.value)))
                                   : errorText(answer.code));
  }
  if (isReached(now)) {
    wanted_.reset();
    refusal_.clear();
  }
  power_due_ = now + (wanted_ || isTransition(power_) ? kPollBusy : kPoll);
}

void Projector::switched(Command command, const Answer& answer, Timestamp now) {
  refusal_.clear();
  switch_due_ = now + (answer.code == Answer::Code::kUnavailable ? kUnavailable : kRepeat);
  power_due_ = now + kPollBusy;
  if (answer.code == Answer::Code::kValue) {
    accepted_ = command == Command::kPowerOn;
    accepted_at_ = now;
    return;
  }
  refusal_ = fmt::format("refuses to be switched {} ({}); it is tried again",
                         command == Command::kPowerOn ? "on" : "off", errorText(answer.code));
}

void Projector::inputSelected(const Answer& answer, Timestamp now) {
  input_due_ = now + kUnavailable;
  input_wanted_ = answer.code == Answer::Code::kUnavailable;
  input_refusal_.clear();
  if (answer.code == Answer::Code::kValue) return;
  input_refusal_ = fmt::format("does not accept input {} ({}){}", settings_.input,
                               errorText(answer.code), input_wanted_ ? "; it is tried again" : "");
}

// The answer has six digits, for fan, lamp, temperature, cover, filter, other: 0 no fault, 1 a
// warning, 2 an error.
void Projector::errors(const Answer& answer) {
  constexpr const char* kParts[] = {"fan", "lamp", "temperature", "cover", "filter", "other"};
  const std::string& value = answer.value;
  const bool good = answer.code == Answer::Code::kValue && value.size() == std::size(kParts) &&
                    value.find_first_not_of("012") == std::string::npos;
  if (!good) return;  // some projectors do not answer in standby; the last report is kept
  warnings_.clear();
  faulty_ = false;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == '0') continue;
    warnings_ += fmt::format("{}{}: {}", warnings_.empty() ? "" : ", ", kParts[i],
                             value[i] == '1' ? "warning" : "error");
    faulty_ = faulty_ || value[i] == '2';
  }
}

void Projector::lamps(const Answer& answer) {
  // The projector has no lamp.
  if (answer.code == Answer::Code::kUndefined) asks_for_lamps_ = false;
  if (answer.code != Answer::Code::kValue) return;
  lamp_hours_ = parseLamps(answer.value);
}

void Projector::lost(const Error& error, Timestamp now) {
  power_ = Power::kUnknown;
  power_fault_.clear();
  trouble_ = error.code == Errc::kInvalidArgument ? Health::kPassword
             : error.code == Errc::kMalformed     ? Health::kFailed
                                                  : Health::kUnreachable;
  trouble_reason_ = error.what;
  quiet_until_ = now + (trouble_ == Health::kPassword ? kPasswordRetry : kReconnect);
  power_due_ = errors_due_ = lamps_due_ = name_due_ = now;
  asks_for_lamps_ = true;
}

ProjectorState Projector::state(Timestamp now) const {
  ProjectorState s;
  s.name = settings_.name;
  s.address = settings_.address;
  s.identity = identity_;
  s.power = power_;
  s.wanted = wanted_;
  if (wanted_ && now < deadline_) s.within = deadline_ - now;
  s.lamp_hours = lamp_hours_;
  s.answers = asked_ && !trouble_;
  judge(s, now);
  return s;
}

// Reports one fault, the most fundamental first: without a connection, for example, nothing else is
// known.
void Projector::judge(ProjectorState& s, Timestamp now) const {
  s.health = asked_ ? Health::kOk : Health::kOpening;
  s.reason = warnings_;
  const auto say = [&s](Health health, const std::string& reason) {
    s.health = health;
    s.reason = reason;
  };
  if (trouble_) return say(*trouble_, trouble_reason_);
  if (!power_fault_.empty()) return say(Health::kFailed, power_fault_);
  if (wanted_ && now > deadline_) {
    return say(Health::kFailed,
               fmt::format("is still {} though it was to be {} by now{}{}", powerName(power_),
                           *wanted_ ? "on" : "off", refusal_.empty() ? "" : "; ", refusal_));
  }
  if (!refusal_.empty()) return say(Health::kRefused, refusal_);
  if (faulty_) return say(Health::kFailed, warnings_);
  if (!input_refusal_.empty()) return say(Health::kRefused, input_refusal_);
}

}  // namespace merlin::pjlink
