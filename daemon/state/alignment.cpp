#include "daemon/state/alignment.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace merlin::state {
namespace {

double thousandths(double px) {
  // Adding 0.0 turns -0 into 0.
  return std::clamp(std::round(px * 1000) / 1000 + 0.0, -kMostSum, kMostSum);
}

Offset sum(const Offset& a, const Offset& b) {
  return {thousandths(a.x + b.x), thousandths(a.y + b.y)};
}

void set(OutputAlignment& output, const Place& place, const Offset& to) {
  if (to == Offset{})
    output.moved.erase(place);
  else
    output.moved[place] = to;
}

}  // namespace

std::optional<Place> cornerNamed(std::string_view name) {
  const auto found = std::ranges::find(kCornerNames, name);
  if (found == std::end(kCornerNames)) return std::nullopt;
  return cornerAt(static_cast<std::size_t>(found - std::begin(kCornerNames)));
}

Place cornerAt(std::size_t corner) {
  return {Place::Of::kPin, static_cast<int>(corner % 2), static_cast<int>(corner / 2 % 2)};
}

std::string nameOf(const Place& place) {
  if (place.of == Place::Of::kPin) return kCornerNames[place.corner()];
  return fmt::format("point {} {}", place.column, place.row);
}

bool OutputForm::fits(const OutputForm& now) const {
  OutputForm known = now;
  if (!corners) known.corners.reset();
  return *this == known;
}

const OutputAlignment* Alignment::find(std::string_view output) const {
  const auto found =
      std::ranges::find_if(outputs, [&](const auto& o) { return o.form.output == output; });
  return found == outputs.end() ? nullptr : &*found;
}

Offset Alignment::offset(std::string_view output, const Place& place) const {
  const OutputAlignment* const of = find(output);
  if (!of) return {};
  const auto found = of->moved.find(place);
  return found == of->moved.end() ? Offset{} : found->second;
}

OutputAlignment& Alignment::entry(const OutputForm& form) {
  const auto found =
      std::ranges::find_if(outputs, [&](const auto& o) { return o.form.output == form.output; });
  if (found != outputs.end()) return *found;
  makeRoom();
  return outputs.emplace_back(OutputAlignment{form, {}});
}

// Removes outputs, with their steps, until one more fits into kMostAligned.
void Alignment::makeRoom() {
  while (outputs.size() >= kMostAligned) {
    const auto unmoved =
        std::ranges::find_if(outputs, [](const OutputAlignment& o) { return o.moved.empty(); });
    const auto& forgotten = unmoved != outputs.end() ? *unmoved : outputs.front();
    (void)take(std::string(forgotten.form.output));
  }
}

void Alignment::add(Step step) {
  steps.resize(done);
  steps.push_back(std::move(step));
  done = steps.size();
  forgetSteps(kMostSteps, kMostChanges);
}

// If all steps are undone, the last one is removed, since the others can be redone without it but
// not without the first one.
void Alignment::forgetSteps(std::size_t most, std::size_t most_changes) {
  while (steps.size() > most || changes() > most_changes) {
    if (done == 0) {
      steps.pop_back();
    } else {
      steps.erase(steps.begin());
      --done;
    }
  }
}

void Alignment::move(const OutputForm& form, const Place& place, const Offset& by) {
  const Offset before = offset(form.output, place), after = sum(before, by);
  if (before == after) return;
  set(entry(form), place, after);
  add({form.output, {{place, before, after}}});
}

void Alignment::moveOn(const OutputForm& form, const Place& place, const Offset& by) {
  const bool same = done > 0 && done == steps.size() && steps.back().output == form.output &&
                    steps.back().changes.size() == 1 && steps.back().changes[0].place == place;
  if (!same) return move(form, place, by);
  Change& change = steps.back().changes[0];
  change.after = sum(change.after, by);
  set(entry(form), place, change.after);
}

bool Alignment::reset(std::string_view output) {
  const auto of =
      std::ranges::find_if(outputs, [&](const auto& o) { return o.form.output == output; });
  if (of == outputs.end() || of->moved.empty()) return false;
  Step step{of->form.output, {}};
  for (const auto& [place, offset] : of->moved) step.changes.push_back({place, offset, {}});
  of->moved.clear();
  add(std::move(step));
  return true;
}

const Step* Alignment::undo() {
  if (done == 0) return nullptr;
  const Step& step = steps[--done];
  for (const Change& c : step.changes) set(entry({step.output}), c.place, c.before);
  return &step;
}

const Step* Alignment::redo() {
  if (done == steps.size()) return nullptr;
  const Step& step = steps[done++];
  for (const Change& c : step.changes) set(entry({step.output}), c.place, c.after);
  return &step;
}

Alignment Alignment::take(std::string_view output) {
  Alignment taken, rest;
  for (OutputAlignment& o : outputs)
    (o.form.output == output ? taken : rest).outputs.push_back(std::move(o));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    Alignment& to = steps[i].output == output ? taken : rest;
    if (i < done) ++to.done;
    to.steps.push_back(std::move(steps[i]));
  }
  *this = std::move(rest);
  return taken;
}

void Alignment::put(const Alignment& taken) {
  makeRoom();
  outputs.insert(outputs.end(), taken.outputs.begin(), taken.outputs.end());
  steps.insert(steps.begin() + static_cast<std::ptrdiff_t>(done), taken.steps.begin(),
               taken.steps.end());
  done += taken.done;
  forgetSteps(kMostSteps, kMostChanges);
}

std::size_t Alignment::changes() const {
  std::size_t all = 0;
  for (const Step& step : steps) all += step.changes.size();
  return all;
}

std::size_t Alignment::moved() const {
  std::size_t all = 0;
  for (const OutputAlignment& output : outputs) all += output.moved.size();
  return all;
}

}  // namespace merlin::state
