// DrawThread: a second thread with its own OpenGL context, which runs the work that its owner hands
// it.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/base/result.h"
#include "render/gl/gl_context.h"

namespace merlin::render::frame {

// Owned and called by one thread. The work runs with this thread's context current.
class DrawThread {
 public:
  // Starts the thread and creates its context by first.makeFurther(). Errors: those of
  // makeFurther().
  static Result<std::unique_ptr<DrawThread>> make(const gl::GlContext& first);
  ~DrawThread();
  DrawThread(const DrawThread&) = delete;
  DrawThread& operator=(const DrawThread&) = delete;

  const gl::GlContext& context() const noexcept { return *context_; }

  // Starts `work`, which must not throw and must stay valid until wait() returns. REQUIRES: no work
  // is in progress.
  void start(const std::function<void()>& work);
  // Blocks until the work is done. Its writes are visible to the caller afterwards.
  void wait();
  void run(const std::function<void()>& work) {
    start(work);
    wait();
  }

 private:
  DrawThread() = default;
  void loop();

  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* work_ = nullptr;  // in progress; guarded by mutex_, like `ends_`
  bool ends_ = false;
  std::unique_ptr<gl::GlContext> context_;  // created and destroyed on `thread_`
  std::jthread thread_;
};

}  // namespace merlin::render::frame
