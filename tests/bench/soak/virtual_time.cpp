#include "tests/bench/soak/virtual_time.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <ucontext.h>

namespace merlin::bench {
namespace {

constexpr std::size_t kStack = std::size_t{1} << 20;

}  // namespace

struct Fibers::Fiber {
  ucontext_t context{};
  std::function<void()> body;
  std::unique_ptr<std::byte[]> stack;  // not initialised, so only the used part occupies memory
  bool returned = false;
};

Fibers::Fibers() : main_(std::make_unique<Fiber>()) {}
Fibers::~Fibers() { assert(waiting_.empty()); }

// makecontext() passes integers only, so the pointer is passed as two halves.
void Fibers::enter(unsigned high, unsigned low) {
  auto* const fiber = reinterpret_cast<Fiber*>(std::uintptr_t{high} << 32 | std::uintptr_t{low});
  fiber->body();
  fiber->returned = true;
  // When this function returns, the main context continues.
}

void Fibers::start(std::function<void()> body) {
  Fiber& fiber = *all_.emplace_back(std::make_unique<Fiber>());
  fiber.body = std::move(body);
  fiber.stack.reset(new std::byte[kStack]);
  ::getcontext(&fiber.context);
  fiber.context.uc_stack.ss_sp = fiber.stack.get();
  fiber.context.uc_stack.ss_size = kStack;
  fiber.context.uc_link = &main_->context;
  const auto at = reinterpret_cast<std::uintptr_t>(&fiber);
  ::makecontext(&fiber.context, reinterpret_cast<void (*)()>(&Fibers::enter), 2,
                static_cast<unsigned>(at >> 32), static_cast<unsigned>(at));
  waiting_.push({now_, order_++, &fiber});
}

void Fibers::runUntil(Timestamp end) {
  assert(!current_);
  end_ = end;
  while (!waiting_.empty() && waiting_.top().when <= end) {
    const Waiting next = waiting_.top();
    waiting_.pop();
    now_ = std::max(now_, next.when);
    current_ = next.fiber;
    ::swapcontext(&main_->context, &next.fiber->context);
    current_ = nullptr;
    if (!next.fiber->returned) continue;
    std::erase_if(all_, [&](const auto& fiber) { return fiber.get() == next.fiber; });
  }
  now_ = std::max(now_, std::min(end, waiting_.empty() ? now_ : end));
}

void Fibers::waitUntil(Timestamp when) {
  assert(current_);
  // Most waits end before those of all other fibers; then no switch of fibers is needed.
  if (when <= end_ && (waiting_.empty() || when < waiting_.top().when)) {
    now_ = std::max(now_, when);
    return;
  }
  Fiber* const self = current_;
  waiting_.push({std::max(when, now_), order_++, self});
  ::swapcontext(&self->context, &main_->context);
}

bool VirtualClock::sleepUntil(Timestamp when, const std::stop_token& stop) noexcept {
  if (stop.stop_requested()) return false;
  fibers_.waitUntil(when);
  return !stop.stop_requested();
}

}  // namespace merlin::bench
