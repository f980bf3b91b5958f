// The steps of `merlin mesh import` from a range image or an elevation map to a mesh.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/progress.h"
#include "render/range/io/range_file.h"
#include "render/range/triangulate.h"

namespace merlin::cli {

// The options for range images.
class RangeImport {
 public:
  void addTo(Command command);
  // Adds the options for reading and for the filters only, for a command that makes its own mesh
  // from several files: all except --max-edge, --feature, --colour-by and --border.
  void addReadingTo(Command command);
  // The name of an option that was given, for a message that it does not apply; empty if none was
  // given.
  std::string anyGiven() const;
  // The name of a given option that only changes a mesh and so would have no effect if the range
  // image is written as a range image; empty if none was given.
  std::string givenForMesh() const;
  // Returns a file name that --angles took as one of its values, because the option stood before
  // the input.
  std::optional<std::string> takeInput();

  // What can be done about a feature whose file is missing, for a message.
  std::string otherFileFor(const std::string& feature) const;

  Result<render::range::RangeOptions> fileOptions() const;

  bool isRaw() const { return !raw_.empty(); }
  bool filters() const { return !between.empty() || !spikes.empty() || median > 0; }

  std::optional<double> scale;  // for any input
  std::string hdu;              // HDU of a FITS file
  std::string variable;         // variable of a file with several maps
  std::string colour_by, max_edge, spikes;
  std::vector<std::string> features;
  std::vector<double> between;
  std::size_t median = 0;
  bool border = false;

 private:
  Argument keep(const char* name, Argument argument);  // for anyGiven()
  void addGeometry(Command command);
  void addRaw(Command command);
  void addMaxEdge(Command command);
  void addFilters(Command command);
  void addFeatures(Command command);

  std::string geometry_, raw_;
  std::vector<std::string> angles_;
  std::vector<double> cell_;
  std::optional<double> exaggeration_, no_return_;
  std::size_t raw_header_ = 0;
  bool raw_interleaved_ = false;
  bool takes_features_ = false;  // --feature
  std::vector<Argument> arguments_;
  std::vector<std::string> names_;
};

// A range image and what was done to it.
struct ImportedRange {
  render::range::RangeImage image;
  std::string format;
  std::vector<std::string> notes;
  std::vector<FeatureFacts> features;
  bool in_metres = false;  // as LoadedRange
  std::size_t returns_in_file = 0, outside = 0, spikes = 0;
  render::range::Threshold max_edge;
  std::string max_edge_text;  // for a person
  render::range::RangeMesh mesh;
  // Origin of the camera transform's coordinates; the mesh is relative to it.
  render::mesh::Origin origin{};
};

// Reads a file with these options, such as render::range::readRange().
using RangeReader = std::function<Result<render::range::LoadedRange>(
    const std::string& path, const render::range::RangeOptions&)>;

// Reads a range image and its modalities. `texture`: whether a picture will be laid over it.
// Errors: those of the readers; kInvalidArgument (two features have the same name; --colour-by is
// invalid).
Result<ImportedRange> loadRange(const std::string& path, const RangeImport& options, bool texture,
                                const RangeReader& read);

// Runs the filters; checks first that `limit` bytes suffice for them and the mesh. Errors:
// kInvalidArgument, kMalformed (nothing is left).
Result<Ok> filterRange(const std::string& path, const RangeImport& options, std::size_t limit,
                       const render::range::Work& work, ImportedRange& range);

// Subtracts from the camera transform an origin near the scanner's position, whose coordinates may
// be those of a map, and returns this origin.
render::mesh::Origin takeOrigin(render::range::Geometry& geometry);
// Subtracts this origin from the camera transform.
void subtract(const render::mesh::Origin& origin, render::range::Geometry& geometry);

// Makes the mesh, relative to range.origin, which takeOrigin() gives. Errors: kMalformed if no
// triangle is within --max-edge.
Result<Ok> meshRange(const std::string& path, const RangeImport& options,
                     const render::range::Work& work, ImportedRange& range);

}  // namespace merlin::cli
