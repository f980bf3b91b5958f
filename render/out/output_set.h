// OutputSet: all outputs of a wall. One that fails takes nothing with it, and how each fares is
// known.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/out/output.h"

namespace merlin::render {

struct NamedOutput {
  std::string name, kind;
  std::unique_ptr<Output> output;
};

// How an output fares.
struct OutputState {
  std::uint64_t frames = 0;  // shown since the start
  std::uint64_t due = 0;     // frames with a deadline that it took, since the start
  std::uint64_t late = 0;    // of these, shown after their deadline
  std::string fault{};       // why the last frame is not shown; empty: all is well
  double lateShare() const {
    return due > 0 ? static_cast<double>(late) / static_cast<double>(due) : 0;
  }
};

// Thread-bound to the wall's thread, but for mend().
class OutputSet {
 public:
  explicit OutputSet(std::vector<NamedOutput> outputs);

  std::size_t size() const noexcept { return entries_.size(); }
  const std::string& name(std::size_t i) const { return entries_[i].named.name; }
  const std::string& kind(std::size_t i) const { return entries_[i].named.kind; }
  const OutputState& state(std::size_t i) const { return entries_[i].state; }
  // Frames that were shown in the second before `now`.
  double shownHz(std::size_t i, Timestamp now) const;

  // Hands a frame to output i. `deadline`: when it was due; none where nothing moves.
  void present(std::size_t i, const Signal& signal, const FrameInfo& info,
               std::optional<Timestamp> deadline);

  // Output::mend() of each, as one sentence; the first error where there is one.
  Result<std::string> mend();

 private:
  struct Entry {
    explicit Entry(NamedOutput output) : named(std::move(output)) {}
    NamedOutput named;
    OutputState state;
    std::deque<Timestamp> shown;  // of the last second
  };
  std::vector<Entry> entries_;
};

}  // namespace merlin::render
