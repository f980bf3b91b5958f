#include "render/frame/draw_thread.h"

#include <cassert>

#include "daemon/base/watched_thread.h"

namespace merlin::render::frame {

Result<std::unique_ptr<DrawThread>> DrawThread::make(const gl::GlContext& first) {
  std::unique_ptr<DrawThread> made(new DrawThread());
  made->thread_ = std::jthread([&thread = *made] {
    nameThread("second drawing");
    thread.loop();
  });
  Result<Ok> ready = Ok{};
  made->run([&] {
    auto context = first.makeFurther();
    if (context)
      made->context_ = *std::move(context);
    else
      ready = context.error();
  });
  if (!ready) return ready.error();
  return made;
}

DrawThread::~DrawThread() {
  run([this] { context_.reset(); });
  const std::lock_guard lock(mutex_);
  ends_ = true;
  changed_.notify_all();
}

void DrawThread::start(const std::function<void()>& work) {
  const std::lock_guard lock(mutex_);
  assert(!work_);
  work_ = &work;
  changed_.notify_all();
}

void DrawThread::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !work_; });
}

void DrawThread::loop() {
  for (;;) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return work_ || ends_; });
    if (!work_) return;
    const std::function<void()>& work = *work_;
    lock.unlock();
    work();
    lock.lock();
    work_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace merlin::render::frame
