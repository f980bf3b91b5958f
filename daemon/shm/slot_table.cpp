#include "daemon/shm/slot_table.h"

#include <cassert>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"
#include "daemon/base/printable_text.h"

namespace merlin::shm {
namespace {

// Returns the name of a field. The name may lack its final NUL, because any program may have
// written the table.
std::string nameOf(const Field& f) { return std::string(textIn(f.name)); }

// Whether both entries describe the same values at the same place. The unit is not compared: it is
// only informative.
bool agree(const Field& a, const Field& b) {
  return std::memcmp(a.type, b.type, sizeof a.type) == 0 && a.count == b.count &&
         a.step == b.step && a.offset == b.offset && a.slot == b.slot && a.ring == b.ring &&
         a.ring_stride == b.ring_stride && a.ring_slots == b.ring_slots;
}

std::string textOf(const Field& f) {
  const std::string_view type = textIn(f.type);
  return fmt::format("{} of type \"{}\" at {}, slot {}, ring {} of {} x {}", f.count, oneLine(type),
                     f.offset, f.slot, f.ring, f.ring_slots, f.ring_stride);
}

}  // namespace

bool TablePlace::fits(std::size_t segment_size) const noexcept {
  if (count == 0) return true;
  const std::uint64_t end = offset + std::uint64_t{count} * field_size;
  return field_size >= sizeof(Field) && end <= segment_size;
}

Result<SlotTable> SlotTable::read(std::span<const std::byte> segment, std::string name) {
  assert(segment.size() >= sizeof(Header));
  const auto& header = *reinterpret_cast<const Header*>(segment.data());
  const TablePlace place{header.field_offset, header.field_count, header.field_size};
  if (!place.fits(segment.size())) {
    return Error{Errc::kMalformed,
                 fmt::format("shared memory {}: its table of fields is not inside it ({} fields of "
                             "{} bytes at {}, of {} bytes)",
                             name, place.count, place.field_size, place.offset, segment.size())};
  }
  SlotTable table(segment, std::move(name));
  for (std::uint32_t i = 0; i < place.count; ++i) {
    Field f;  // NOLINT(*-member-init): memcpy fills it
    std::memcpy(&f, segment.data() + place.offset + std::size_t{i} * place.field_size, sizeof f);
    if (table.fields_.emplace(nameOf(f), f).second) table.names_.push_back(nameOf(f));
  }
  return table;
}

std::vector<std::string> SlotTable::namesBefore(std::string_view ending) const {
  std::vector<std::string> names;
  for (const std::string& name : names_) {
    if (name.ends_with(ending)) names.push_back(name.substr(0, name.size() - ending.size()));
  }
  return names;
}

const Field* SlotTable::find(const char* field) const {
  const auto found = fields_.find(std::string_view(field));
  return found == fields_.end() ? nullptr : &found->second;
}

Error SlotTable::malformed(const std::string& slot, const std::string& what) const {
  return {Errc::kMalformed,
          fmt::format("shared memory {}: its slot {} {}; use this program and merlind of the same "
                      "release",
                      name_, slot, what)};
}

// The offset of the slot follows from the offset of its first field in the table. All fields in the
// table are then compared with those that a slot of this type has at this offset.
Result<std::size_t> SlotTable::locate(const std::string& slot, Describe describe, std::size_t size,
                                      std::size_t alignment) const {
  constexpr std::size_t kAnywhere = 1 << 16;
  const Field probe = describe(slot, kAnywhere).front();
  const Field* first = find(probe.name);
  if (!first) {
    return Error{Errc::kUnsupported,
                 fmt::format("shared memory {}: has no slot {} (no field {}); use this program and "
                             "merlind from the same release",
                             name_, slot, probe.name)};
  }
  const std::int64_t offset =
      std::int64_t{first->offset} - (std::int64_t{probe.offset} - std::int64_t{kAnywhere});
  const auto end = offset + static_cast<std::int64_t>(size);
  if (offset < static_cast<std::int64_t>(sizeof(Header)) ||
      offset % static_cast<std::int64_t>(alignment) != 0 ||
      end > static_cast<std::int64_t>(segment_.size())) {
    return malformed(
        slot, fmt::format("would be the bytes {} to {} of {}", offset, end, segment_.size()));
  }
  const auto place = static_cast<std::size_t>(offset);
  for (const Field& expected : describe(slot, place)) {
    const Field* found = find(expected.name);
    if (!found) return malformed(slot, fmt::format("lacks the field {}", expected.name));
    if (!agree(*found, expected)) {
      return malformed(slot, fmt::format("has the field {} as {}; this program expects {}",
                                         expected.name, textOf(*found), textOf(expected)));
    }
  }
  return place;
}

}  // namespace merlin::shm
