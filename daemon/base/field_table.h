// The table by which a shared-memory segment describes its fields to readers that do not use our
// header files, and a class that builds it.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace merlin::shm {

// One field of a segment: `count` values, `step` bytes from one to the next, the first at `offset`.
// `type` is a format of Python's struct module for one value: q i64, Q u64, i i32, I u32, h i16,
// H u16, B u8, f f32, d f64, 20s a NUL-ended text of at most 20 bytes. Little-endian.
//
// `slot` is the offset of the u64 sequence number that guards the values: read it before and after
// them; if it is odd or has changed, read again; 0 means never written. A `slot` of 0 means that
// the field has no guard; a single word is read atomically.
//
// `ring` is the offset of a channel's ring of last samples, 0 for a field without one. Sample
// number n is in ring slot n % ring_slots, which starts at ring + (n % ring_slots) * ring_stride
// with a sequence number of its own; the field's values start (offset - slot) bytes after that.
struct Field {
  char name[48];  // "glove.angle_rad"
  char unit[24];  // "rad"
  char type[8];
  std::uint32_t count;
  std::uint32_t step;         // [bytes]
  std::uint32_t offset;       // from the segment's start [bytes]
  std::uint32_t slot;         // from the segment's start [bytes]
  std::uint32_t ring;         // from the segment's start [bytes]
  std::uint32_t ring_stride;  // [bytes]
  std::uint32_t ring_slots;
  std::uint32_t reserved;
};
static_assert(sizeof(Field) == 112 && offsetof(Field, count) == 80);

// Offset of a slot's value from the slot's start [bytes]: the value follows the sequence number.
inline constexpr std::size_t kSlotPayload = 8;

// Returns the letter of a C++ type in Field::type; '?' if it has none.
template <typename T>
constexpr char fieldType() {
  if constexpr (std::is_enum_v<T>) {
    return fieldType<std::underlying_type_t<T>>();
  } else if constexpr (std::is_same_v<T, char>) {
    return 's';
  } else if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? 'f' : 'd';
  } else {
    static_assert(std::is_integral_v<T>);
    constexpr const char* kSigned = "?bh?i???q";
    constexpr const char* kUnsigned = "?BH?I???Q";
    return (std::is_signed_v<T> ? kSigned : kUnsigned)[sizeof(T)];
  }
}

// Collects the fields of a segment. REQUIRES: all names and units fit into a Field.
class FieldTable {
 public:
  // The fields added from now on are in the slot at `offset`; their names begin with `prefix`.
  void slot(std::string_view prefix, std::size_t offset) {
    now_ = {};
    prefix_ = prefix;
    now_.slot = static_cast<std::uint32_t>(offset);
    base_ = offset + kSlotPayload;
  }
  // The fields added from now on are in the slot at `offset`, whose last samples are in a ring.
  void slot(std::string_view prefix, std::size_t offset, std::size_t ring, std::size_t stride,
            std::size_t slots) {
    slot(prefix, offset);
    now_.ring = static_cast<std::uint32_t>(ring);
    now_.ring_stride = static_cast<std::uint32_t>(stride);
    now_.ring_slots = static_cast<std::uint32_t>(slots);
  }
  // The fields added from now on have no guard; their offsets count from `offset`.
  void bare(std::string_view prefix, std::size_t offset) {
    now_ = {};
    prefix_ = prefix;
    base_ = offset;
  }

  // Adds a member, or an array, as one field.
  template <typename Member>
  void add(std::string_view name, std::size_t offset, std::string_view unit) {
    using Element = std::remove_all_extents_t<Member>;
    constexpr std::size_t kElements =
        sizeof(Member) / sizeof(Element);  // NOLINT(bugprone-sizeof-expression)
    if constexpr (std::is_same_v<Element, char>) {
      append(name, offset, unit, std::to_string(kElements) + "s", {1, kElements});
    } else {
      append(name, offset, unit, std::string(1, fieldType<Element>()),
             {kElements, sizeof(Element)});
    }
  }
  // Adds one field of `count` values: the same member of `count` structs that are `step` bytes
  // apart.
  template <typename Member>
  void addOfEach(std::string_view name, std::size_t offset, std::string_view unit,
                 std::size_t count, std::size_t step) {
    add<Member>(name, offset, unit);
    assert(fields_.back().count == 1);
    fields_.back().count = static_cast<std::uint32_t>(count);
    fields_.back().step = static_cast<std::uint32_t>(step);
  }

  std::vector<Field> take() { return std::move(fields_); }

 private:
  void append(std::string_view name, std::size_t offset, std::string_view unit,
              const std::string& type, std::pair<std::size_t, std::size_t> count_and_step) {
    Field f = now_;
    const std::string full = prefix_ + "." + std::string(name);
    assert(full.size() < sizeof f.name && unit.size() < sizeof f.unit);
    assert(type.size() < sizeof f.type);
    std::copy(full.begin(), full.end(), f.name);
    std::copy(unit.begin(), unit.end(), f.unit);
    std::copy(type.begin(), type.end(), f.type);
    f.count = static_cast<std::uint32_t>(count_and_step.first);
    f.step = static_cast<std::uint32_t>(count_and_step.second);
    f.offset = static_cast<std::uint32_t>(base_ + offset);
    fields_.push_back(f);
  }

  std::string prefix_;
  std::size_t base_ = 0;
  Field now_{};
  std::vector<Field> fields_;
};

#define MERLIN_FIELD(table, Struct, member, unit) \
  (table).add<decltype(Struct::member)>(#member, offsetof(Struct, member), unit)

// Adds the first 40 bytes of a segment, which are the same in all segments: how to recognise it and
// find its table. Header has these members. REQUIRES: the table's fields have no guard now.
template <typename Header>
void addTableHeader(FieldTable& t) {
  MERLIN_FIELD(t, Header, magic, "");
  MERLIN_FIELD(t, Header, version, "");
  MERLIN_FIELD(t, Header, size, "B");
  MERLIN_FIELD(t, Header, generation, "");
  MERLIN_FIELD(t, Header, field_offset, "B");
  MERLIN_FIELD(t, Header, field_count, "");
  MERLIN_FIELD(t, Header, field_size, "B");
  MERLIN_FIELD(t, Header, pid, "");
}

// Copies the fields to `place` in a segment and stores its offset, size and count in the header.
// Header has field_offset, field_count and field_size. REQUIRES: `place` is after `header` in the
// same segment and has room for all fields.
template <typename Header>
void setFields(Header& header, std::span<Field> place, const std::vector<Field>& fields) {
  assert(fields.size() <= place.size());
  std::copy(fields.begin(), fields.end(), place.begin());
  header.field_offset =
      static_cast<std::uint32_t>(reinterpret_cast<const std::byte*>(place.data()) -
                                 reinterpret_cast<const std::byte*>(&header));
  header.field_size = sizeof(Field);
  header.field_count = static_cast<std::uint32_t>(fields.size());
}

}  // namespace merlin::shm
