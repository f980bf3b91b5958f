// Alignment: how far people have moved the corners and mesh points of outputs while the daemon
// runs, and the steps in which they did so, which can be undone and redone. Pure.
//
// The offsets are added to the correction that is configured for each output.
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

// Limits of an alignment, so that the state file stays far below the maximum size of a JSON file.
inline constexpr std::size_t kMostSteps = 100;     // number of steps that can be undone
inline constexpr std::size_t kMostChanges = 4000;  // number of changes in all steps together
inline constexpr std::size_t kMostMoved = 4000;    // number of moved places of all outputs together
inline constexpr std::size_t kMostAligned = 256;   // outputs, even if no longer configured
inline constexpr double kMostOffset = 16384;       // maximum of |x| and |y| of one move [px]
inline constexpr double kMostSum = 1e6;            // same for the sum of a place's moves [px]

// Names of the corners, in the order of CorrectionSettings::corners: index 2 * row + column.
inline constexpr const char* kCornerNames[] = {"top_left", "top_right", "bottom_left",
                                               "bottom_right"};

// A point of an output that can be moved: a corner (column and row are 0 or 1), or a point of the
// mesh (column and row are counted from 0).
struct Place {
  enum class Of { kPin, kMesh };

  Of of = Of::kPin;
  int column = 0, row = 0;

  auto operator<=>(const Place&) const = default;  // NOLINT(modernize-use-nullptr): of its making
  std::size_t corner() const {
    return 2 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column);
  }
};
// Returns the corner with this name of kCornerNames; nothing if there is none.
std::optional<Place> cornerNamed(std::string_view name);
Place cornerAt(std::size_t corner);
// Returns the name of a corner, such as "top_left", or "point 2 0" for the mesh point in column 2
// and row 0.
std::string nameOf(const Place& place);

// A displacement in pixels of the output, x to the right and y down.
struct Offset {
  double x = 0, y = 0;
  bool operator==(const Offset&) const = default;
};

// The properties that an output had when it was aligned. The offsets are valid only as long as the
// output has these properties. `corners` is one of them because somebody may write the aligned
// corners into the configuration; the offsets must then not be added again.
struct OutputForm {
  std::string output;                   // name of the output
  int width = 0, height = 0;            // size of its picture [px]
  int mesh_columns = 0, mesh_rows = 0;  // number of columns and rows of the mesh; 0: no mesh
  // CorrectionSettings::corners in the configuration; nothing: not known, because an earlier
  // version of merlind wrote the state file.
  std::optional<std::array<double, 8>> corners{};
  bool operator==(const OutputForm&) const = default;
  // Whether an alignment that was made for this form is valid for an output of the form `now`, i.e.
  // all properties are equal. `corners` is ignored if it is not known here.
  bool fits(const OutputForm& now) const;
};

struct OutputAlignment {
  OutputForm form;
  std::map<Place, Offset> moved;  // places with an offset other than 0, 0
};  // an entry without moved places is kept, since steps may refer to it

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
  std::vector<Step> steps;  // oldest first
  std::size_t done = 0;     // number of steps in effect; the steps after these can be redone

  // Offset of a place from its configured position; 0, 0 if it was not moved.
  Offset offset(std::string_view output, const Place& place) const;
  // Returns the entry of an output in `outputs`; null if there is none, i.e. if nothing of the
  // output was moved.
  const OutputAlignment* find(std::string_view output) const;

  // move(), moveOn() and reset() add one step each, unless nothing changes; they remove the steps
  // that were undone, and the oldest steps beyond the limits. Offsets are rounded to thousandths of
  // a pixel. If a new output would exceed kMostAligned, another output is removed with its steps:
  // the oldest one without moved places, otherwise the oldest one.
  //
  // move() moves a place by an offset.
  void move(const OutputForm& form, const Place& place, const Offset& by);
  // Moves a place like move(), but extends the last step instead of adding one if that step moved
  // the same place and nothing is undone. For a ball that is being pushed.
  void moveOn(const OutputForm& form, const Place& place, const Offset& by);
  // Moves all places of the output back to their configured positions, in one step. Returns false
  // if no place of it is moved.
  bool reset(std::string_view output);

  // Undoes the last step in effect, or redoes the one after it, and returns this step; null if
  // there is none. The pointer is valid until the next change of the steps.
  const Step* undo();
  const Step* redo();

  // Removes the offsets and the steps of an output, and returns an alignment that contains only
  // these.
  Alignment take(std::string_view output);
  // Adds an alignment that take() has returned. Its steps count as the newest ones. Steps and
  // outputs beyond the limits are removed as by move(). REQUIRES: this alignment has no output of
  // the same name.
  void put(const Alignment& taken);
  // moved() returns the number of moved places of all outputs, changes() the number of changes in
  // all steps.
  std::size_t moved() const;
  std::size_t changes() const;
  // Whether no place is moved and there is no step.
  bool isNothing() const { return moved() == 0 && steps.empty(); }
  // Removes steps until at most `most` steps with at most `most_changes` changes in all are left:
  // the oldest ones, or the last ones if all steps are undone.
  void forgetSteps(std::size_t most, std::size_t most_changes);

 private:
  OutputAlignment& entry(const OutputForm& form);
  void makeRoom();
  void add(Step step);
};

}  // namespace merlin::state
