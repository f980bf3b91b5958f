#include "daemon/cli/mesh/pose_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/range/io/words.h"

namespace merlin::cli {

Result<render::range::Pose> readPose(const std::string& path) {
  constexpr std::size_t kMostBytes = 4096;  // enough for 16 numbers and spaces
  const auto file = FileCopy::read(path, kMostBytes);
  if (!file) return file.error();
  const std::vector<double> numbers = render::range::numbersOf(file->text(), 16);
  if (numbers.size() != 12 && numbers.size() != 16)
    return Error{Errc::kMalformed,
                 path + ": is not a pose; allowed are three or four rows of four numbers"};
  if (numbers.size() == 16 &&
      !(numbers[12] == 0 && numbers[13] == 0 && numbers[14] == 0 && numbers[15] == 1))
    return Error{Errc::kMalformed,
                 fmt::format("{}: the fourth row is {} {} {} {}; allowed is 0 0 0 1", path,
                             numbers[12], numbers[13], numbers[14], numbers[15])};
  render::range::Pose pose{};
  std::copy_n(numbers.begin(), pose.size(), pose.begin());
  return pose;
}

}  // namespace merlin::cli
