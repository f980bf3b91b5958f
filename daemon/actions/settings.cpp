#include "daemon/actions/settings.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "daemon/actions/input.h"
#include "daemon/base/commands.h"

namespace merlin {
namespace {

bool isLamp(std::string_view action) { return action.starts_with("lamp_"); }

// Whether no single moment may trigger both: a hand does one thing at a time, and the lamp has one
// state.
bool exclude(std::string_view a, std::string_view b) {
  return a == b || (isHeldAction(a) && isHeldAction(b)) || (isLamp(a) && isLamp(b));
}

bool atLeave(const Binding& b) { return b.when == When::kLeave; }

std::string conflictText(const Binding& a, const Binding& b) {
  const char* when = isHeldAction(b.action) ? "held" : atLeave(b) ? "left" : "entered";
  if (a.action == b.action)
    return fmt::format("\"{}\" would {} twice when {}", b.input, b.action, when);
  return fmt::format("\"{}\" would both {} and {} when {}, which exclude each other", b.input,
                     a.action, b.action, when);
}

// The second input of a chord, the time of a long press, and what repeats.
void checkTimes(const Binding& b, const std::string& at, SettingFaults& faults) {
  const auto input = actions::parseInput(b.input);
  const auto with = actions::parseInput(b.with);
  if (!b.with.empty() && (!with || with->isMomentary())) {
    faults.push_back({at + "/with", fmt::format("is \"{}\"; allowed are the forms of input, "
                                                "without gestures and panel.button",
                                                b.with)});
  } else if (input && with && (input->device != with->device || *input == *with)) {
    faults.push_back({at + "/with", fmt::format("is \"{}\"; allowed is another input of the device "
                                                "of \"{}\"",
                                                b.with, b.input)});
  }
  if (b.repeat_s > 0 && (isHeldAction(b.action) || atLeave(b)))
    faults.push_back({at + "/repeat_s", "repeats only what happens once, as its input begins"});
}

// An input that is over as it begins triggers only what happens once.
void checkMomentary(const actions::Input& input, const Binding& b, const std::string& at,
                    SettingFaults& faults) {
  const bool panel = input.kind == actions::Input::Kind::kPanelButton;
  const bool held = isHeldAction(b.action);
  if (b.after_s > 0 || b.repeat_s > 0 || !b.with.empty())
    faults.push_back(
        {at, fmt::format("gives {} with, after_s or repeat_s, which it has not: it only tells that "
                         "it was {}",
                         b.input, panel ? "pressed" : "made")});
  if (held || atLeave(b))
    faults.push_back(
        {at, fmt::format("binds {} to {}; {} only triggers actions that happen once, when it is {}",
                         b.input,
                         held    ? b.action
                         : panel ? "its release"
                                 : "its end",
                         panel ? "the panel's button" : "a gesture", panel ? "pressed" : "made")});
}

void checkOne(const Binding& b, const std::string& at, SettingFaults& faults) {
  const auto input = actions::parseInput(b.input);
  if (!input)
    faults.push_back(
        {at + "/input", fmt::format("is \"{}\"; allowed are {}", b.input, kInputForms)});
  const bool held = isHeldAction(b.action);
  if (b.when != When::kByAction && (b.when == When::kHold) != held) {
    const char* const when = !held ? "hold" : atLeave(b) ? "leave" : "enter";
    faults.push_back({at + "/on", fmt::format("is {}, but {} {}", when, b.action,
                                              held ? "lasts as long as its input is held: set hold"
                                                   : "happens once: set enter or leave")});
  }
  checkTimes(b, at, faults);
  if (input && input->isMomentary()) checkMomentary(*input, b, at, faults);
}

// What all inputs have in common that one event can be, whatever device they name.
std::string partOf(const actions::Input& input) {
  return fmt::format("{} {} {}", static_cast<int>(input.kind), input.button, input.name);
}

}  // namespace

// Linear in the number of bindings: for each moment of an input at most one binding of each action
// is kept, and each input has few moments. A binding to an input alone and a chord with that input
// happen at different moments: as the chord begins, only the chord acts (ActionWriter).
SettingFaults validate(const std::vector<Binding>& bindings) {
  SettingFaults faults;
  std::map<std::pair<std::string, bool>, std::vector<std::size_t>> before;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const Binding& b = bindings[i];
    const std::string at = fmt::format("/{}", i);
    checkOne(b, at, faults);
    const auto input = actions::parseInput(b.input);
    auto& same_moment = before[{input ? partOf(*input) : b.input, atLeave(b)}];
    const auto j = std::find_if(same_moment.begin(), same_moment.end(), [&](std::size_t k) {
      const auto other = actions::parseInput(bindings[k].input);
      const bool same_time = bindings[k].with == b.with && bindings[k].after_s == b.after_s;
      return (!input || !other || input->overlaps(*other)) &&
             (same_time || isHeldAction(b.action)) && exclude(bindings[k].action, b.action);
    });
    if (j == same_moment.end()) {
      same_moment.push_back(i);
      continue;
    }
    faults.push_back({at, conflictText(bindings[*j], b), fmt::format("/{}", *j)});
  }
  return faults;
}

}  // namespace merlin
