// Alignment: how far people have moved the corners and mesh points of outputs while the daemon
// runs, and the steps in which they did it, to be undone and redone. Pure.
//
// The configured correction is the base, to which the offsets are added.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::state {

// Limits of an alignment, so that it stays far below what a file of JSON may have.
inline constexpr std::size_t kMostSteps = 100;     // that can be undone
inline constexpr std::size_t kMostChanges = 4000;  // in all steps together
inline constexpr std::size_t kMostMoved = 4000;    // places of all outputs together
inline constexpr std::size_t kMostAligned = 256;   // outputs, also those that are gone
inline constexpr double kMostOffset = 16384;       // of one move [px], either sign
inline constexpr double kMostSum = 1e6;            // of all moves of a place, likewise

// Names of corners, in the order of a correction's `corners`: index 2 * row + column.
inline constexpr const char* kCornerNames[] = {"top_left", "top_right", "bottom_left",
                                               "bottom_right"};

// What can be moved: a corner (column and row 0 or 1), or a point of the mesh, counted from 0.
struct Place {
  enum class Of { kPin, kMesh };

  Of of = Of::kPin;
  int column = 0, row = 0;

  auto operator<=>(const Place&) const = default;  // NOLINT(modernize-use-nullptr): of its making
  std::size_t corner() const {
    return 2 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column);
  }
};
// The corner with that name; nothing if there is none.
std::optional<Place> cornerNamed(std::string_view name);
Place cornerAt(std::size_t corner);
// "top_left", or "point 2 0" with column and row.
std::string nameOf(const Place& place);

// A displacement in pixels of the output, x to the right and y down.
struct Offset {
  double x = 0, y = 0;
  bool operator==(const Offset&) const = default;
};

// The properties that an output had when it was aligned; the offsets are valid for these only.
// `corners` is among them because somebody may write the aligned corners into the configuration,
// and the offsets must then not be added again.
struct OutputForm {
  std::string output;                   // its name
  int width = 0, height = 0;            // of its picture [px]
  int mesh_columns = 0, mesh_rows = 0;  // 0: no mesh
  // A correction's `corners` in the configuration; nothing: unknown, because an earlier version
  // wrote the file.
  std::optional<std::array<double, 8>> corners{};
  bool operator==(const OutputForm&) const = default;
  // Whether an alignment that was made for this form is one for an output of the form `now`.
  bool fits(const OutputForm& now) const;
};

struct OutputAlignment {
  OutputForm form;
  std::map<Place, Offset> moved;  // only places that are not where the configuration puts them
};  // kept even if nothing is moved any more, since steps may refer to it

struct Change {
  Place place;
  Offset before, after;
};
struct Step {
  std::string output;
  std::vector<Change> changes;
};

struct Alignment {
  std::vector<OutputAlignment> outputs;
  std::vector<Step> steps;  // the oldest first
  std::size_t done = 0;     // number of steps in effect; those after them can be redone

  // Offset of a place from its configured position; 0, 0 if it was not moved.
  Offset offset(std::string_view output, const Place& place) const;
  // The alignment of an output; null if nothing of it was ever moved.
  const OutputAlignment* find(std::string_view output) const;

  // Each of these adds one step, and forgets the steps that were undone and the oldest ones beyond
  // the limits. Offsets are rounded to thousandths of a pixel. Beyond kMostAligned outputs, what
  // was moved first is forgotten, those first of which nothing is moved any more.
  void move(const OutputForm& form, const Place& place, const Offset& by);
  // The same, but as a part of the last step if that moved the same place, for a ball that is being
  // pushed.
  void moveOn(const OutputForm& form, const Place& place, const Offset& by);
  // Moves all places of the output back to the configuration. Returns false if none is moved.
  bool reset(std::string_view output);

  // Undoes or redoes a step and returns it; null if there is none.
  const Step* undo();
  const Step* redo();

  // Removes an output's offsets and steps, and returns an alignment that has these alone.
  Alignment take(std::string_view output);
  // Adds what take() has returned. Its steps count as the newest ones; the oldest ones beyond the
  // limits are forgotten, and outputs as by move(). REQUIRES: this alignment has no output of that
  // name.
  void put(const Alignment& taken);
  // Number of places that are moved, of all outputs, and of changes in all steps.
  std::size_t moved() const;
  std::size_t changes() const;
  // Whether nothing is moved and there is no step.
  bool isNothing() const { return moved() == 0 && steps.empty(); }
  // Forgets the oldest steps until there are at most `most` of them, with `most_changes` changes in
  // all.
  void forgetSteps(std::size_t most, std::size_t most_changes);

 private:
  OutputAlignment& entry(const OutputForm& form);
  void makeRoom();
  void add(Step step);
};

}  // namespace merlin::state
