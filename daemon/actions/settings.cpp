#include "daemon/actions/settings.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/actions/input.h"
#include "daemon/base/commands.h"

namespace merlin {
namespace {

bool isLamp(std::string_view action) { return action.starts_with("lamp_"); }

// Pairs of actions of which each undoes the other one.
constexpr std::pair<std::string_view, std::string_view> kOpposites[] = {
    {"next_content", "previous_content"}, {"projector_on", "projector_off"}, {"video_a", "video_b"},
    {"align_left", "align_right"},        {"align_up", "align_down"},
};

bool areOpposites(std::string_view a, std::string_view b) {
  return std::ranges::any_of(kOpposites, [&](const auto& pair) {
    return pair == std::pair(a, b) || pair == std::pair(b, a);
  });
}

// Whether two actions must not be triggered at the same moment: they are the same or opposites, or
// both are held, since a hand does only one thing at a time, or both set the lamp.
bool exclude(std::string_view a, std::string_view b) {
  return a == b || (isHeldAction(a) && isHeldAction(b)) || (isLamp(a) && isLamp(b)) ||
         areOpposites(a, b);
}

// Actions that happen once and change what is shown or what the ball moves.
constexpr std::string_view kOfView[] = {"reset_view",       "next_mode",    "next_content",
                                        "previous_content", "blank",        "freeze",
                                        "operator_panel",   "next_testcard"};

bool isOfView(std::string_view action) { return std::ranges::count(kOfView, action) > 0; }

// Whether a person cannot want one moment of an input to trigger both actions, because they exclude
// each other, or because one hides the effect of the other.
bool clash(std::string_view a, std::string_view b) {
  return exclude(a, b) || (isOfView(a) && isOfView(b));
}

bool atLeave(const Binding& b) { return b.when == When::kLeave; }

// Whether one event can be both inputs. Also true if a text is not the name of an input; that is
// reported as a fault of its own.
bool overlap(const std::string& a, const std::string& b) {
  const auto first = actions::parseInput(a), second = actions::parseInput(b);
  return !first || !second || first->overlaps(*second);
}

// Whether both bindings are to the same chord, but name its two inputs in opposite order.
bool areSameChord(const Binding& a, const Binding& b) {
  return !a.with.empty() && !b.with.empty() && overlap(a.with, b.input) && overlap(a.input, b.with);
}

std::string conflictText(const Binding& a, const Binding& b) {
  const char* when = isHeldAction(b.action) ? "held" : atLeave(b) ? "left" : "entered";
  if (a.action == b.action)
    return fmt::format("\"{}\" would {} twice when {}", b.input, b.action, when);
  if (exclude(a.action, b.action))
    return fmt::format("\"{}\" would both {} and {} when {}, which exclude each other", b.input,
                       a.action, b.action, when);
  if (areSameChord(a, b))
    return fmt::format(
        "\"{}\" with \"{}\" and the same two inputs in the other order are one chord, which would "
        "both {} and {}",
        b.input, b.with, a.action, b.action);
  return fmt::format(
      "\"{}\" would both {} and {} when {}; of the actions that change what is shown or what the "
      "ball moves, an input triggers only one at a time",
      b.input, a.action, b.action, when);
}

// Checks the second input of a chord, and the period of repetition.
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
  } else if (input && with && !input->isMomentary() && input->rulesOut(*with)) {
    faults.push_back(
        {at + "/with",
         fmt::format(
             "is \"{}\", which is never held together with \"{}\", so the chord would never "
             "happen",
             b.with, b.input)});
  }
  if (b.repeat_s > 0 && b.repeat_s < kShortestRepeat_s)
    faults.push_back({at + "/repeat_s", fmt::format("is {}; allowed are 0 and {} to {}", b.repeat_s,
                                                    kShortestRepeat_s, kLongestRepeat_s)});
  if (b.repeat_s > 0 && (isHeldAction(b.action) || atLeave(b)))
    faults.push_back({at + "/repeat_s", "repeats only what happens once, as its input begins"});
}

// Checks a binding to a momentary input: such an input can only trigger an action that happens
// once, without `with`, after_s and repeat_s.
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
  if (b.action.empty()) return;
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

// Returns a key that is equal for inputs of the same kind, button and name, whatever device they
// name. Only inputs with equal keys can overlap.
std::string partOf(const actions::Input& input) {
  return fmt::format("{} {} {}", static_cast<int>(input.kind), input.button, input.name);
}

// Whether one event can be the second input of both bindings, or neither binding has a second
// input.
bool needSameSecond(const Binding& a, const Binding& b) {
  return a.with.empty() == b.with.empty() && (a.with.empty() || overlap(a.with, b.with));
}

// The bindings that precede the one to be checked, ordered by the keys of their inputs (partOf()).
class BindingsBefore {
 public:
  explicit BindingsBefore(const std::vector<Binding>& all) : all_(all) {}

  void add(std::size_t i) {
    const Binding& b = all_[i];
    by_input_[keyOf(b.input, b)].push_back(i);
    if (!b.with.empty()) by_with_[keyOf(b.with, b)].push_back(i);
  }

  // Returns the index of a binding that would be triggered together with `b` although a person
  // cannot want that; nothing if there is none.
  std::optional<std::size_t> excluded(const Binding& b) {
    // Whether the action of `b` is held and excluded by the action of binding `k`.
    const auto lastsBeside = [&](std::size_t k) {
      return isHeldAction(b.action) && exclude(all_[k].action, b.action);
    };
    for (const std::size_t k : by_input_[keyOf(b.input, b)]) {
      const bool same_time = needSameSecond(all_[k], b) && all_[k].after_s == b.after_s;
      const bool meet = (same_time && clash(all_[k].action, b.action)) || lastsBeside(k);
      if (meet && overlap(b.input, all_[k].input)) return k;
    }
    // Then the preceding chords whose second input is the input of `b`.
    for (const std::size_t k : by_with_[keyOf(b.input, b)]) {
      const bool same_chord = areSameChord(all_[k], b);
      const bool meet = (same_chord && all_[k].after_s == b.after_s) ||
                        ((same_chord || b.with.empty()) && lastsBeside(k));
      if (meet && overlap(b.input, all_[k].with)) return k;
    }
    if (b.with.empty()) return std::nullopt;
    for (const std::size_t k : by_input_[keyOf(b.with, b)])
      if (all_[k].with.empty() && lastsBeside(k) && overlap(b.with, all_[k].input)) return k;
    return std::nullopt;
  }

 private:
  using Places = std::map<std::pair<std::string, bool>, std::vector<std::size_t>>;

  static std::pair<std::string, bool> keyOf(const std::string& text, const Binding& b) {
    const auto input = actions::parseInput(text);
    return {input ? partOf(*input) : text, atLeave(b)};
  }

  const std::vector<Binding>& all_;
  Places by_input_, by_with_;
};

}  // namespace

// The cost is linear in the number of bindings, because BindingsBefore stores few bindings for each
// input. A binding to an input alone and a chord with this input do not conflict: when the chord
// begins, only the chord acts (see ActionWriter).
SettingFaults validate(const std::vector<Binding>& bindings) {
  SettingFaults faults;
  BindingsBefore before(bindings);
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const std::string at = fmt::format("/{}", i);
    checkOne(bindings[i], at, faults);
    if (bindings[i].action.empty()) continue;
    const auto j = before.excluded(bindings[i]);
    if (j)
      faults.push_back({at, conflictText(bindings[*j], bindings[i]), fmt::format("/{}", *j)});
    else
      before.add(i);
  }
  return faults;
}

}  // namespace merlin
