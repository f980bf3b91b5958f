// Postures: names for the network's five-bit codes, and the recogniser.
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

// Returns whether `name` consists of 1 to kLongestName letters, digits, '-' or '_', so that it is
// safe in JSON, in CSV and on a command line.
bool isPostureName(std::string_view name) noexcept;

// Maps codes to posture names and back, one to one. Cheap to copy; a look-up allocates nothing.
class PostureTable {
 public:
  // Errors: kInvalidArgument if the code is above 31, the name invalid, or either is already used.
  Result<Ok> add(std::uint32_t code, std::string_view name);

  // Returns the name of a code, valid as long as the table exists; empty if the code has no name.
  std::string_view name(std::uint32_t code) const noexcept;
  std::optional<std::uint32_t> code(std::string_view name) const noexcept;
  std::size_t size() const noexcept;  // number of codes with a name

 private:
  std::array<std::array<char, kLongestName + 1>, kCodes> names_{};  // NUL-ended
};

// Returns a code as five binary digits, output 4 first, output 0 last, as it is written in files.
std::string formatCode(std::uint32_t code);
// Returns the code that formatCode() writes as `digits`; nothing for any other text.
std::optional<std::uint32_t> parseCode(std::string_view digits) noexcept;

// Everything that recognition needs. Plain data, about 2.6 kB.
struct PostureNetwork {
  Phi phi = Phi::kSigmoid;
  InputUnit unit = InputUnit::kRadians;
  InputRanges ranges = kGloveRanges;
  Weights weights;
  PostureTable postures;
};

struct Recognition {
  std::uint32_t code;  // threshold(activation)
  Output activation;   // the outputs
  // The code's name; empty for no posture. Valid as long as the recogniser exists.
  std::string_view name;
  // Certainty: the least |2 Y_k - 1| over the outputs, 0..1; NaN if a value of the hand is not
  // finite.
  float margin;
};

// Recognises postures from a glove's values. Immutable, hence thread-safe.
class Recogniser {
 public:
  explicit Recogniser(const PostureNetwork& network);

  // Recognises the posture of a hand. If a value is not finite, the result has code 0, activations
  // NaN and no name, even if the table names code 0. Allocation-free; about 0.1 us.
  Recognition operator()(const Angles& value) const noexcept;

  std::string_view name(std::uint32_t code) const noexcept { return postures_.name(code); }

 private:
  InputRanges ranges_;
  Recall recall_;
  PostureTable postures_;
};

}  // namespace merlin::nn
