#include "daemon/cli/mesh/input_kinds.h"

#include <algorithm>
#include <iterator>

#include "daemon/base/files.h"
#include "daemon/base/words.h"
#include "render/mesh/io/gzip.h"
#include "render/mesh/io/mesh_file.h"
#include "render/points/io/cloud_file.h"
#include "render/range/io/range_file.h"

namespace merlin::cli {
namespace {

// Number of bytes in which the mark of a text format is searched.
constexpr std::size_t kLooked = 4096;

std::string_view beginningOf(std::string_view content) {
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  const std::size_t from = content.find_first_not_of(" \t\r\n");
  return content.substr(std::min(from, content.size()), kLooked);
}

bool isXmlWith(std::string_view content, std::string_view mark) {
  content = beginningOf(content);
  return content.starts_with('<') && content.find(mark) != std::string_view::npos;
}

bool isCollada(std::string_view content) { return isXmlWith(content, "<COLLADA"); }
bool isX3d(std::string_view content) { return isXmlWith(content, "<X3D"); }
bool isAmf(std::string_view content) { return isXmlWith(content, "<amf"); }

// Recognises glTF as JSON by any of its usual keys, because the keys of a JSON object may have any
// order.
bool isGltf(std::string_view content) {
  constexpr std::string_view kKeys[] = {"\"asset\"", "\"accessors\"", "\"bufferViews\"",
                                        "\"meshes\""};
  return beginningOf(content).starts_with('{') &&
         std::ranges::any_of(kKeys, [head = content.substr(0, 1 << 16)](std::string_view key) {
           return head.find(key) != std::string_view::npos;
         });
}

// Recognises a 3DS file: a chunk 0x4D4D whose first subchunk is the version (0x0002) or the
// editor's data (0x3D3D).
bool is3ds(std::string_view content) {
  if (content.size() < 16 || !content.starts_with("MM")) return false;
  const std::string_view first = content.substr(6, 2);
  return first == std::string_view("\x02\x00", 2) || first == "==";
}

bool isZipWith(std::string_view content, std::string_view name) {
  return content.starts_with("PK\x03\x04") && content.find(name) != std::string_view::npos;
}
bool is3mf(std::string_view content) { return isZipWith(content, "3D/3dmodel.model"); }

bool isDxf(std::string_view content) {
  const std::string_view head = beginningOf(content);
  return head.starts_with("AutoCAD Binary DXF") ||
         ((head.starts_with("0\n") || head.starts_with("0\r") || head.starts_with("999")) &&
          head.find("SECTION") != std::string_view::npos);
}

bool isLightWave(std::string_view content) {
  return content.starts_with("FORM") && content.size() > 12 &&
         (content.substr(8, 3) == "LWO" || content.substr(8, 4) == "LXOB");
}

bool isTiff(std::string_view content) {
  constexpr std::string_view kMarks[] = {{"II*\0", 4}, {"MM\0*", 4}, {"II+\0", 4}, {"MM\0+", 4}};
  return std::ranges::any_of(kMarks, [&](std::string_view m) { return content.starts_with(m); });
}

// Recognises a USGS DEM by two numbers in its first record: the code of the elevation pattern (1 or
// 4) and the code of the planimetric reference system (0 to 3).
bool isUsgsDem(std::string_view content) {
  if (content.size() < 1024) return false;
  const std::string_view pattern = content.substr(150, 6), system = content.substr(156, 6);
  return (pattern == "     1" || pattern == "     4") && system.starts_with("     ") &&
         system[5] >= '0' && system[5] <= '3';
}

// Returns whether there is a text file with the same name but the ending .hdr that states rows and
// columns, as for GTOPO30 and other raw grids, which consist of two files.
bool hasHeaderBeside(const std::string& path) {
  constexpr std::size_t kMost = 4096;
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] != '.') return false;
  for (const char* ending : {".hdr", ".HDR"}) {
    const std::string header = path.substr(0, dot) + ending;
    const auto file = header == path ? Error{Errc::kNotFound, {}} : FileCopy::read(header, kMost);
    if (!file) continue;
    const std::string text = lowerCase(file->text());
    if (text.find("nrows") != std::string::npos && text.find("ncols") != std::string::npos)
      return true;
  }
  return false;
}

// A format that merlin-import reads, recognised by `mark` at the beginning of the file or, if `is`
// is not null, by that function.
struct ForeignFormat {
  const char* kind;    // first argument of merlin-import
  const char* format;  // for a person
  const char* ending;
  std::string_view mark{};
  bool (*is)(std::string_view content) = nullptr;
};

constexpr ForeignFormat kForeign[] = {
    {kGridKind, "FITS", "fits", "SIMPLE  ="},
    {kGridKind, "GeoTIFF", "tif", {}, isTiff},
    {kGridKind, "USGS DEM", "dem", {}, isUsgsDem},
    {kGridKind, "DTED", "dt2", "UHL1"},
    {kGridKind, "Erdas Imagine", "img", "EHFA_HEADER_TAG"},
    {kGridKind, "netCDF", "nc", "CDF"},
    {kGridKind, "HDF5", "h5", "\x89HDF"},
    {kGridKind, "Surfer", "grd", "DSAA"},
    {kGridKind, "Surfer", "grd", "DSBB"},
    {kGridKind, "Surfer", "grd", "DSRB"},
    {kGridKind, "Binary Terrain", "bt", "binterr"},
    {kGridKind, "PCIDSK", "pix", "PCIDSK  "},
    {kGridKind, "GRIB", "grb", "GRIB"},
    {"model", "Open Inventor", "iv", "#Inventor V"},
    {"model", "VRML", "wrl", "#VRML V"},
    {"model", "glTF", "glb", "glTF"},
    {"model", "glTF", "gltf", {}, isGltf},
    {"model", "COLLADA", "dae", {}, isCollada},
    {"model", "3DS", "3ds", {}, is3ds},
    {"model", "FBX", "fbx", "Kaydara FBX Binary"},
    {"model", "FBX", "fbx", "; FBX"},
    {"model", "X3D", "x3d", {}, isX3d},
    {"model", "3MF", "3mf", {}, is3mf},
    {"model", "AMF", "amf", {}, isAmf},
    {"model", "DXF", "dxf", {}, isDxf},
    {"model", "LightWave", "lwo", {}, isLightWave},
    {"model", "AC3D", "ac", "AC3Db"},
    {"model", "Blender", "blend", "BLENDER"},
    {"model", "DirectX", "x", "xof "},
    {"model", "3ds Max ASE", "ase", "*3DSMAX_ASCIIEXPORT"},
    {"model", "Milkshape", "ms3d", "MS3D000000"},
    {"model", "Quake II", "md2", "IDP2"},
    {"model", "Quake III", "md3", "IDP3"},
    {"model", "Doom 3", "md5mesh", "MD5Version"},
    {"model", "IQM", "iqm", "INTERQUAKEMODEL"},
    {"model", "TrueSpace", "cob", "Caligari "},
    {"model", "Blitz3D", "b3d", "BB3D"},
};

bool isOf(const ForeignFormat& f, std::string_view content) {
  return f.is ? f.is(content) : content.starts_with(f.mark);
}

// Recognises Inventor and VRML files that are compressed by gzip, which is common; merlin-import
// decompresses them.
std::optional<InputKind> packedKindOf(std::string_view content) {
  constexpr std::size_t kBeginning = 64;
  const std::string beginning = render::mesh::gunzipBeginning(content, kBeginning);
  if (render::mesh::isGzip(beginning)) return std::nullopt;  // compressed twice
  auto kind = foreignKindOf(beginning);
  if (!kind || (kind->ending != "iv" && kind->ending != "wrl")) return std::nullopt;
  kind->format += ", gzip";
  return kind;
}

}  // namespace

std::optional<InputKind> foreignKindOf(std::string_view content) {
  if (render::mesh::isGzip(content)) return packedKindOf(content);
  const auto found =
      std::ranges::find_if(kForeign, [&](const ForeignFormat& f) { return isOf(f, content); });
  if (found == std::end(kForeign)) return std::nullopt;
  return InputKind{InputReader::kForeign, found->kind, found->ending, found->format};
}

std::optional<InputKind> inputKindOf(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return std::nullopt;
  const auto cloud = render::points::cloudFormatOf(file->text());
  if (cloud) return InputKind{InputReader::kForeign, kPointsKind, {}, *cloud};
  if (render::range::isRangeFile(path)) return InputKind{InputReader::kRange};
  if (render::mesh::isMeshFile(path)) return InputKind{InputReader::kMesh};
  if (auto foreign = foreignKindOf(file->text())) return foreign;
  if (hasHeaderBeside(path))
    return InputKind{InputReader::kForeign, kGridKind, "dem",
                     "a raw grid with its header beside it"};
  const auto text = render::points::textCloudFormatOf(file->text());
  if (text) return InputKind{InputReader::kForeign, kPointsKind, {}, *text};
  if (render::mesh::isReadable(path)) return InputKind{InputReader::kMesh};
  return std::nullopt;
}

std::string InputKind::unit() const {
  constexpr std::string_view kMetres[] = {"iv", "wrl", "glb", "gltf", "x3d", "dae"};
  const bool metres = isGrid() || std::ranges::find(kMetres, ending) != std::end(kMetres);
  return metres ? "m" : "";
}

std::string foreignFormats() {
  std::string list;
  std::string_view last;
  for (const ForeignFormat& f : kForeign) {
    if (f.format != last) list += (list.empty() ? "" : ", ") + std::string(f.format);
    last = f.format;
  }
  return list;
}

}  // namespace merlin::cli
