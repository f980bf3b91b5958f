#include "tests/system/kept_models.h"

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace merlin::test {

std::string keptModel(const std::string& name,
                      const std::function<Outcome(const std::string& path)>& make) {
  namespace fs = std::filesystem;
  const fs::path bin = MERLIN_BIN_DIR, folder = bin.parent_path() / "test-models";
  const fs::path kept = folder / name;
  std::error_code absent;
  const auto made = fs::last_write_time(kept, absent);
  if (!absent && made > fs::last_write_time(bin / "merlin")) return kept;
  fs::create_directories(folder);
  const fs::path own = folder / fmt::format("{}-{}", ::getpid(), name);
  const Outcome done = make(own);
  EXPECT_EQ(done.status, 0) << done.output;
  fs::rename(own, kept);
  return kept;
}

std::string makeFullModel(const TempDir& dir) {
  const std::string kept = keptModel("full.mrm", [](const std::string& path) {
    return run({MERLIN_BIN_DIR "/merlin", "mesh", "reduce",
                MERLIN_SOURCE_DIR "/config/models/ankylosaurus.ply", "-o", path});
  });
  std::filesystem::copy_file(kept, dir / "full.mrm");
  return dir / "full.mrm";
}

std::string makeModel(const TempDir& dir, int percent) {
  const std::string merlin = MERLIN_BIN_DIR "/merlin";
  const std::string kept =
      keptModel(fmt::format("{}-percent.mrm", percent), [&](const std::string& path) {
        const TempDir work;
        const std::string small = work / "small.ply";
        const Outcome cut = run({merlin, "mesh", "export", makeFullModel(work), "--percent",
                                 std::to_string(percent), "-o", small});
        EXPECT_EQ(cut.status, 0) << cut.output;
        return run({merlin, "mesh", "reduce", small, "-o", path});
      });
  std::filesystem::copy_file(kept, dir / "model.mrm",
                             std::filesystem::copy_options::overwrite_existing);
  return dir / "model.mrm";
}

}  // namespace merlin::test
