// Projector: what is known of one projector, and what is to be sent to it next. Pure: time and
// answers are passed in.
//
// What the projector answers counts, not what it was sent: it is asked for its power before each
// switching and until it has reached the state that is wanted. A projector that cools down is
// switched on when it says that it is off, one that warms up is switched off when it says that it
// is on. A command that it refuses is repeated until it is accepted, or until another is wanted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "drivers/pjlink/protocol.h"
#include "drivers/pjlink/settings.h"

namespace merlin::pjlink {

enum class Power { kUnknown, kOff, kWarming, kOn, kCooling };
enum class Health {
  kOpening,      // not reached yet
  kOk,           // answers, and reports no fault
  kUnreachable,  // cannot be connected to, or does not answer
  kPassword,     // the password is wrong or missing
  kRefused,      // does not accept a command
  kFailed,       // reports a fault, does not do what it accepted, or does not speak PJLink
};

// Words for status and messages: "on", "unknown"; "ok", "wrong_password".
const char* powerName(Power power);
const char* healthName(Health health);

struct ProjectorState {
  std::string name, address;
  std::string identity;  // as the projector calls itself; empty: unknown
  Power power = Power::kUnknown;
  std::optional<bool> wanted;  // the state that it has not reached yet
  // Time within which it must have reached that; PJLink does not tell more. Nothing: unknown.
  std::optional<Duration> within{};
  Health health = Health::kOpening;
  std::string reason;           // what is wrong; empty: nothing
  bool answers = false;         // whether the last connection did what it was for
  std::vector<int> lamp_hours;  // of each lamp; empty: unknown
};

// Thread-bound.
class Projector {
 public:
  // It is asked for its power at once; what it is to be is not known.
  Projector(const PjlinkSettings& settings, Timestamp now);

  // The power that it is to have from now on. A state that it reached by itself or by its remote
  // control is not changed.
  void want(bool on, Timestamp now);

  // What is to be sent now; nothing before due().
  std::optional<Command> next(Timestamp now) const;
  Timestamp due() const;

  // The projector has answered `command`.
  void answered(Command command, const Answer& answer, Timestamp now);
  // The projector was not reached, or the connection broke: its power is unknown. `error`:
  // kInvalidArgument (the password), kMalformed (it does not speak PJLink), others (unreachable).
  void lost(const Error& error, Timestamp now);

  ProjectorState state(Timestamp now) const;

 private:
  std::optional<Command> switching() const;
  bool isReached(Timestamp now) const;
  void power(const Answer& answer, Timestamp now);
  void switched(Command command, const Answer& answer, Timestamp now);
  void inputSelected(const Answer& answer, Timestamp now);
  void errors(const Answer& answer);
  void lamps(const Answer& answer);
  void judge(ProjectorState& state, Timestamp now) const;

  PjlinkSettings settings_;
  Power power_ = Power::kUnknown;
  std::optional<bool> wanted_;
  bool input_wanted_ = false;
  bool asked_ = false;  // it has answered since the last connection was lost
  bool asks_for_lamps_ = true;
  std::optional<bool> accepted_;  // the switching that it accepted last
  Timestamp accepted_at_;
  Timestamp quiet_until_;  // nothing is sent before
  Timestamp power_due_, switch_due_, input_due_, errors_due_, lamps_due_, name_due_;
  Timestamp deadline_;             // by which `wanted_` must be reached
  std::optional<Health> trouble_;  // of the connection
  std::string trouble_reason_, refusal_, power_fault_, input_refusal_;
  std::string identity_, warnings_;
  bool faulty_ = false;  // one of `warnings_` is an error
  std::vector<int> lamp_hours_;
};

}  // namespace merlin::pjlink
