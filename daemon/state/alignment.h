// Alignment: how far people have moved the corners and mesh points of outputs while the daemon
// runs, and the steps in which they did it, to be undone and redone. Pure.
//
// A correction of the configuration is the base: an offset is added to it.
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
// Nothing if there is no corner of that name.
std::optional<Place> cornerNamed(std::string_view name);
Place cornerAt(std::size_t corner);
// "top_left", or "point 2 0" with column and row.
std::string nameOf(const Place& place);

// Pixels of the output, x to the right and y down.
struct Offset {
  double x = 0, y = 0;
  bool operator==(const Offset&) const = default;
};

// What an output was when it was aligned; offsets fit no other form. Whoever writes the aligned
// corners into the configuration wants them there once, without the offsets.
struct OutputForm {
  std::string output;                   // its name
  int width = 0, height = 0;            // of its picture [px]
  int mesh_columns = 0, mesh_rows = 0;  // 0: no mesh
  // A correction's `corners` in the configuration; nothing: not known, from an earlier version.
  std::optional<std::array<double, 8>> corners{};
  bool operator==(const OutputForm&) const = default;
};

struct OutputAlignment {
  OutputForm form;
  std::map<Place, Offset> moved;  // only what is not where the configuration says
};  // stays when everything is back in its place: steps may refer to it

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
  std::size_t done = 0;     // of them; those behind were undone and can be redone

  // Where a place is from where the configuration says; 0, 0 for what was not moved.
  Offset offset(std::string_view output, const Place& place) const;
  // Null where nothing was ever moved.
  const OutputAlignment* find(std::string_view output) const;

  // Each of these makes one step, and forgets those that were undone, and the oldest beyond the
  // limits. Offsets are kept in thousandths of a pixel.
  void move(const OutputForm& form, const Place& place, const Offset& by);
  // The same, as a part of the last step if that moved the same place: a ball that is being pushed.
  void moveOn(const OutputForm& form, const Place& place, const Offset& by);
  // Back to the configuration. False if nothing of the output is moved.
  bool reset(std::string_view output);

  // Undoes or redoes a step and returns it; null if there is none.
  const Step* undo();
  const Step* redo();

  // Forgets an output's offsets and steps.
  void forget(std::string_view output);
  // Number of places that are moved, of all outputs.
  std::size_t moved() const;

 private:
  OutputAlignment& entry(const OutputForm& form);
  void add(Step step);
};

}  // namespace merlin::state
