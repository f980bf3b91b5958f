// Postures: the network's five bits, the names that they stand for, and recall as a whole.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "nn/inputs.h"
#include "nn/network.h"
#include "nn/recall.h"

namespace merlin::nn {

inline constexpr std::uint32_t kCodes = 1U << kOutputs;
inline constexpr std::size_t kLongestName = 19;  // characters

// 1 to kLongestName letters, digits, '-' or '_': safe in JSON, in CSV and on a command line.
bool isPostureName(std::string_view name) noexcept;

// Code to name, and back. One code a name, one name a code. Copies freely; looking up allocates
// nothing.
class PostureTable {
 public:
  // Errors: kInvalidArgument: code above 31, no posture name, code or name already taken.
  Result<Ok> add(std::uint32_t code, std::string_view name);

  // Empty where the code has no name. Valid as long as the table.
  std::string_view name(std::uint32_t code) const noexcept;
  std::optional<std::uint32_t> code(std::string_view name) const noexcept;
  std::size_t size() const noexcept;  // codes with a name

 private:
  std::array<std::array<char, kLongestName + 1>, kCodes> names_{};  // NUL-ended
};

// A code as files write it: five digits, output 4 first, output 0 last.
std::string formatCode(std::uint32_t code);
std::optional<std::uint32_t> parseCode(std::string_view digits) noexcept;

// All that recall needs. Plain data, about 2.6 kB.
struct PostureNetwork {
  Phi phi = Phi::kSigmoid;
  InputUnit unit = InputUnit::kRadians;
  InputRanges ranges = kGloveRanges;
  Weights weights;
  PostureTable postures;
};

struct Recognition {
  std::uint32_t code;     // threshold(activation)
  Output activation;      // the outputs as they are
  std::string_view name;  // of the code; empty: no posture. Valid as long as the recogniser
  float margin;           // how sure: the least |2 Y_k - 1| over the outputs, 0..1; NaN: not at all
};

// From a glove's values to a posture. Immutable: thread-safe.
class Recogniser {
 public:
  explicit Recogniser(const PostureNetwork& network);

  // Recognises the posture of a hand. A value that is not finite is never a posture, whatever the
  // table says: code 0, activations NaN, no name. Allocation-free; about 0.1 us.
  Recognition operator()(const Angles& value) const noexcept;

  std::string_view name(std::uint32_t code) const noexcept { return postures_.name(code); }

 private:
  InputRanges ranges_;
  Recall recall_;
  PostureTable postures_;
};

}  // namespace merlin::nn
