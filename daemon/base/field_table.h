// The table by which a shared-memory segment describes itself to readers without a header file, and
// what a writer needs to fill it.
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
// `slot` is the offset of the u64 sequence that guards the values: read it before and after them;
// odd or changed means try again, 0 means never written. A `slot` of 0: no guard; a word is read
// whole.
//
// `ring` is the offset of a channel's last samples, 0 for a field that has none. Sample number n
// lies in ring slot n % ring_slots, which starts at ring + (n % ring_slots) * ring_stride with a
// sequence of its own; the field's values start (offset - slot) bytes after that.
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

// Where a slot's value begins: after its sequence.
inline constexpr std::size_t kSlotPayload = 8;

// The letter of a C++ type; '?' for none.
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

// Gathers a segment's fields. REQUIRES of all: names and units fit into a Field.
class FieldTable {
 public:
  // The fields added from here on lie in the slot at `offset`; their names begin with `prefix`.
  void slot(std::string_view prefix, std::size_t offset) {
    now_ = {};
    prefix_ = prefix;
    now_.slot = static_cast<std::uint32_t>(offset);
    base_ = offset + kSlotPayload;
  }
  // The same, of a slot whose last samples lie in a ring of slots.
  void slot(std::string_view prefix, std::size_t offset, std::size_t ring, std::size_t stride,
            std::size_t slots) {
    slot(prefix, offset);
    now_.ring = static_cast<std::uint32_t>(ring);
    now_.ring_stride = static_cast<std::uint32_t>(stride);
    now_.ring_slots = static_cast<std::uint32_t>(slots);
  }
  // The fields added from here on have no guard; their offsets count from `offset`.
  void bare(std::string_view prefix, std::size_t offset) {
    now_ = {};
    prefix_ = prefix;
    base_ = offset;
  }

  // A member, or an array of them: one field.
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
  // The same member of each of `count` structs that lie `step` bytes apart.
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

// Copies the fields into their place in a segment and says in its header where that is. Header has
// field_offset, field_count and field_size. REQUIRES: `place` lies behind `header` in one segment
// and holds all of them.
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
