// How mesh files are written: one file a format, one row of the table in mesh_file.cpp. Private to
// render/mesh/io.
#pragma once

#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct MeshWriter {
  const char* ending;
  bool (*carries)(const Feature&);                // whether the format has a place for it
  bool (*write)(const Mesh&, const WriteBytes&);  // false where the file takes no more
  // Whether the mesh fits into the format; the error is without the file's name. May be null.
  Result<Ok> (*fits)(const Mesh&) = nullptr;
};

extern const MeshWriter kPlyWriter, kObjWriter, kGlbWriter, kGltfWriter, kStlWriter,
    kInventorWriter;

// "normal", "colour" and "texcoord" in their usual dimensions: what formats have names for.
bool isUsual(const Feature& f);

// The feature if it is there in that dimension, else nullptr.
const Feature* findOf(const Mesh& mesh, std::string_view name, std::size_t dimension);

// Formatted text in blocks; remembers a refusal.
class TextSink {
 public:
  explicit TextSink(const WriteBytes& write) : write_(write) {}

  template <typename... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > kBlock) flush();
  }

  // Rows of `width` numbers between `before` and `after`, each parted by a space.
  void printRows(const std::vector<float>& values, std::size_t width, std::string_view before,
                 std::string_view after) {
    for (std::size_t i = 0; i < values.size(); i += width) {
      print("{}{}", before, values[i]);
      for (std::size_t k = 1; k < width; ++k) print(" {}", values[i + k]);
      print("{}", after);
    }
  }

  // Whether all was taken.
  bool finish() {
    flush();
    return taken_;
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16;

  void flush() {
    taken_ = taken_ && write_(std::as_bytes(std::span(text_)));
    text_.clear();
  }

  const WriteBytes& write_;
  std::string text_;
  bool taken_ = true;
};

}  // namespace merlin::render
