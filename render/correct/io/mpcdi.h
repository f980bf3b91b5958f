// MPCDI: a file format for measured warps and blends of projectors, written by calibration tools
// and read by media servers. Profile "2d", versions 1 and 2.
//
// A zip archive without folders: mpcdi.xml lists buffers (the picture of a display), their regions
// (the part of one projector), and for each region a geometry warp (PFM), an alpha map and
// optionally a beta map (PNG). README.md says which parts are read and written.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/correct/correction_map.h"

namespace merlin::render::correct {

// Maximum number of cells of each map of a region: 4096 x 4096.
inline constexpr std::size_t kMostMeasuredCells = std::size_t{1} << 24;

struct MpcdiRegion {
  std::string buffer, id;
  int width = 0, height = 0;  // [px]
  double gamma = 0;           // gamma of the region's colours; 0: not in the file
  // The part of the buffer's picture that the warp's range 0..1 stands for, as the region's
  // attributes say ("x 0.5, y 0, xSize 0.5, ySize 1"); empty: the whole. Not used: see README.md.
  std::string part{};
};

// Thread-bound.
class Mpcdi {
 public:
  // Borrows `bytes`, the content of a file. Errors: kMalformed (not a complete archive, an entry in
  // a folder, a missing or malformed mpcdi.xml), kUnsupported (another profile or version, or a
  // limit is exceeded).
  static Result<Mpcdi> open(std::span<const std::byte> bytes);
  Mpcdi(const Mpcdi&) = delete;
  Mpcdi& operator=(const Mpcdi&) = delete;
  Mpcdi(Mpcdi&&) noexcept;
  Mpcdi& operator=(Mpcdi&&) noexcept;
  ~Mpcdi();

  // Returns all regions, in the file's order; at least one.
  std::vector<MpcdiRegion> regions() const;

  // Reads the maps of the region with this id; if it is empty, of the only region. Errors:
  // kInvalidArgument (there is no such region, or several and none is named); kNotFound,
  // kMalformed, kUnsupported (from its maps).
  Result<MeasuredCorrection> measured(const std::string& region) const;

 private:
  struct Content;
  explicit Mpcdi(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

// Reads the maps of a region from a copy of the file at `path`. Errors: those of FileCopy::read(),
// kUnsupported (more than 1 GiB), and those of Mpcdi::open() and Mpcdi::measured(), with the file's
// name.
Result<MeasuredCorrection> readMeasured(const std::string& path, const std::string& region);

// The data of one output that are written to an MPCDI file.
struct MpcdiOutput {
  std::string name;           // id of its buffer and of its region
  int width = 0, height = 0;  // [px]
  double gamma = 2.2;
  std::vector<Place> places{};  // for each pixel, from Warp::places()
  Shares shares{};
  std::array<double, 3> black{};
  bool measured = false;  // the shares come from a measured correction, not from ramps
};

// Computes, from an output's settings, what mpcdiBytes() writes for it. REQUIRES: as for
// makeCorrectionMap().
MpcdiOutput mpcdiOutput(const std::string& name, const CorrectionSettings& settings, int width,
                        int height, const MeasuredCorrection* measured, Threads threads);

// Returns an MPCDI file with one buffer of one region per output. `date`: date to be written, ISO
// 8601. Errors: kIo (no memory).
Result<std::string> mpcdiBytes(const std::vector<MpcdiOutput>& outputs, const std::string& date);

}  // namespace merlin::render::correct
