// Projector: keeps the known state of one projector, and determines what is to be sent to it next.
// Pure: time and answers are passed in.
//
// The state is what the projector reports, not what it was told: it is asked for its power before
// each switching, and afterwards until it has reached the wanted state. A projector that cools down
// is switched on once it reports that it is off; one that warms up is switched off once it reports
// that it is on. A refused command is repeated until it is accepted or another state is wanted.
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
  kOpening,      // no connection so far
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
  std::optional<bool> wanted;  // requested state, until it is reached
  // Time left to reach `wanted`; PJLink reports no progress. Nothing: unknown.
  std::optional<Duration> within{};
  Health health = Health::kOpening;
  std::string reason;           // what is wrong; empty: nothing
  bool answers = false;         // whether the last connection served its purpose
  std::vector<int> lamp_hours;  // for each lamp; empty: unknown
};

// Thread-bound.
class Projector {
 public:
  // The projector is asked for its power at once; no state is wanted yet.
  Projector(const PjlinkSettings& settings, Timestamp now);

  // Sets the wanted state. Once the projector has reached it, later changes by itself or its remote
  // control are left alone.
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
  bool asked_ = false;  // has answered since the last connection was lost
  bool asks_for_lamps_ = true;
  std::optional<bool> accepted_;  // last command to switch that it accepted
  Timestamp accepted_at_;
  Timestamp quiet_until_;  // nothing is sent before
  Timestamp power_due_, switch_due_, input_due_, errors_due_, lamps_due_, name_due_;
  Timestamp deadline_;             // by which `wanted_` must be reached
  std::optional<Health> trouble_;  // trouble of the connection
  std::string trouble_reason_, refusal_, power_fault_, input_refusal_;
  std::string identity_, warnings_;
  bool faulty_ = false;  // one of `warnings_` is an error
  std::vector<int> lamp_hours_;
};

}  // namespace merlin::pjlink
