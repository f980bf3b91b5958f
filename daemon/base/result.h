// Result<T>: a value, or an error that says why there is none.
//
// Every call that can fail at run time (a port, a file, a peer) returns a Result. A violated
// precondition is a bug and an assert(). No exception crosses a component's boundary; third-party
// exceptions are caught in the adapter that calls the third party.
//
// C++20 has no std::expected; with C++23 this class becomes an alias of it.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace merlin {

enum class Errc {
  kTimeout,          // nothing arrived in time; the peer or device may be fine
  kClosed,           // the peer has closed the connection, or we were asked to stop
  kIo,               // the operating system reported an error
  kNotFound,         // a file, port or key does not exist
  kMalformed,        // bytes or text do not follow their format
  kInvalidArgument,  // a value is out of range
  kUnsupported,      // valid, but not available here
  kBusy,             // another process uses it
  kNoMemory,         // more memory is needed than this process may have
};

struct [[nodiscard]] Error {
  Errc code;
  std::string what;  // for a person: names the thing and the figures, never "failed"
};

// The value type of a call that has no value: Result<Ok> only says whether the call succeeded.
struct Ok {};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: implicit by design
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: implicit by design

  bool ok() const noexcept { return std::holds_alternative<T>(state_); }
  explicit operator bool() const noexcept { return ok(); }

  T& operator*() & { return (assert(ok()), *std::get_if<T>(&state_)); }
  const T& operator*() const& { return (assert(ok()), *std::get_if<T>(&state_)); }
  T&& operator*() && { return (assert(ok()), std::move(*std::get_if<T>(&state_))); }
  T* operator->() { return &**this; }
  const T* operator->() const { return &**this; }
  const Error& error() const { return (assert(!ok()), *std::get_if<Error>(&state_)); }

 private:
  std::variant<T, Error> state_;
};

}  // namespace merlin
