// ShownPictures: the thumbnails of contents that are not in the configuration, which were taken
// while the wall showed them. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace merlin::page {

// Thread-bound.
class ShownPictures {
 public:
  struct Picture {
    std::string name;
    std::shared_ptr<const std::string> jpeg;
    std::uint64_t number = 0;  // differs from that of every picture before it
  };

  // Keeps the picture for the content `name`, in place of an earlier one. If kMost other contents
  // have pictures, the one with the oldest picture loses its place. Returns false if the content
  // has this picture already. `number`: the picture's number.
  bool keep(const std::string& name, std::string jpeg, std::uint64_t number);

  // Returns the pictures. A content keeps its index until it loses its place.
  const std::vector<Picture>& all() const noexcept { return pictures_; }

  static constexpr std::size_t kMost = 50;  // as many names as the wall lists

 private:
  std::vector<Picture> pictures_;
};

}  // namespace merlin::page
