// MissingContents: stores which contents of the configuration cannot be shown yet, and why.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace merlin::wall {

// A place is the index of a content in contentsOf(). Thread-safe; no call waits for long.
class MissingContents {
 public:
  // `faults`: for each place, why its content cannot be shown; empty: it can be shown.
  explicit MissingContents(std::vector<std::string> faults) : faults_(std::move(faults)) {}

  // Returns why the content of a place cannot be shown; empty if it can be shown, or if there is no
  // such place.
  std::string faultOf(std::size_t place) const {
    const std::lock_guard lock(mutex_);
    return place < faults_.size() ? faults_[place] : "";
  }
  void set(std::size_t place, std::string fault) {
    const std::lock_guard lock(mutex_);
    if (place < faults_.size()) faults_[place] = std::move(fault);
  }
  void nowShown(std::size_t place) { set(place, {}); }
  std::vector<std::string> faults() const {
    const std::lock_guard lock(mutex_);
    return faults_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> faults_;
};

}  // namespace merlin::wall
