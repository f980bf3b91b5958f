// Result<T>: a value, or the one reason why there is none.
//
// Every call that can fail at run time (a port, a file, a peer) returns a Result. A broken
// precondition is a bug, not a result: it is an assert(). Nothing in MERLIN throws across a
// component's border; third-party exceptions are caught in the adapter that calls the third party.
//
// C++20 has no std::expected (C++23); when the compiler moves, this file becomes a `using`.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace merlin {

enum class Errc {
  kTimeout,          // nothing came in time; the thing itself is fine
  kClosed,           // the peer went away, or we were asked to stop
  kIo,               // the operating system refused
  kNotFound,         // a file, port or key that is not there
  kMalformed,        // bytes or text that do not follow their format
  kInvalidArgument,  // a value out of its range
  kUnsupported,      // understood, and not available here
  kBusy,             // somebody else holds it
};

struct [[nodiscard]] Error {
  Errc code;
  std::string what;  // for a person: names the thing and the figures, never "failed"
};

// The value of a call that only succeeds or fails.
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
