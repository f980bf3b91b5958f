// Projector: keeps the known state of one projector, and determines what is to be sent to it next.
// Pure: time and answers are passed in.
//
// The state is the one that the projector reports, not the one that was last commanded: the
// projector is asked for its power before each switching, and afterwards until it has reached the
// wanted state. A projector that is cooling down is switched on once it reports that it is off; a
// projector that is warming up is switched off once it reports that it is on. A refused command is
// repeated until it is accepted or another state is wanted.
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

// Return words for status and messages, such as "on" or "unknown", and "ok" or "wrong_password".
const char* powerName(Power power);
const char* healthName(Health health);

struct ProjectorState {
  std::string name, address;
  std::string identity;  // the projector's own name; empty: unknown
  Power power = Power::kUnknown;
  std::optional<bool> wanted;  // requested state, until it is reached
  // Time left in which `wanted` must be reached, by the settings, since PJLink reports no progress.
  // Nothing if no state is wanted or the time is over.
  std::optional<Duration> within{};
  Health health = Health::kOpening;
  std::string reason;           // fault or warning; empty: none
  bool answers = false;         // whether it answered in the newest connection
  std::vector<int> lamp_hours;  // for each lamp; empty: unknown
};

// Thread-bound.
class Projector {
 public:
  // The first command asks for the projector's power, at once; no state is wanted yet.
  Projector(const PjlinkSettings& settings, Timestamp now);

  // Sets the wanted state. Once the projector has reached it, later changes by itself or its remote
  // control are left alone.
  void want(bool on, Timestamp now);

  // Returns the command that is to be sent now; nothing before due().
  std::optional<Command> next(Timestamp now) const;
  Timestamp due() const;

  // To be called when the projector has answered `command`.
  void answered(Command command, const Answer& answer, Timestamp now);
  // To be called when the projector was not reached, or the connection broke; its power is unknown
  // from then on. `error` determines the health: kInvalidArgument gives Health::kPassword,
  // kMalformed gives Health::kFailed, any other code gives Health::kUnreachable.
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
  bool asked_ = false;  // has ever answered a command
  bool asks_for_lamps_ = true;
  std::optional<bool> accepted_;  // last power command that it accepted: on or off
  Timestamp accepted_at_;
  Timestamp quiet_until_;  // nothing is sent before this time
  Timestamp power_due_, switch_due_, input_due_, errors_due_, lamps_due_, name_due_;
  Timestamp deadline_;             // time by which `wanted_` must be reached
  std::optional<Health> trouble_;  // fault of the connection
  std::string trouble_reason_, refusal_, power_fault_, input_refusal_;
  std::string identity_, warnings_;
  bool faulty_ = false;  // one of `warnings_` is an error
  std::vector<int> lamp_hours_;
};

}  // namespace merlin::pjlink
