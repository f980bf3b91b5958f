// DrawThread: a second thread with an OpenGL context of its own, that does what it is told.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/base/result.h"
#include "render/gl/gl_context.h"

namespace merlin::render {

// One owner, on one thread. What is told to it runs with its context current.
class DrawThread {
 public:
  // On another display than the first context: Mesa's software renderers draw one after the other
  // on one. Errors: makeGlContext()'s.
  static Result<std::unique_ptr<DrawThread>> make();
  ~DrawThread();
  DrawThread(const DrawThread&) = delete;
  DrawThread& operator=(const DrawThread&) = delete;

  const GlContext& context() const noexcept { return *context_; }

  // Begins `work`, which must not throw and outlive wait(). REQUIRES: nothing is under way.
  void start(const std::function<void()>& work);
  // Until it is done. What it wrote is seen afterwards.
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
  const std::function<void()>* work_ = nullptr;  // under way; guarded, as `ends_`
  bool ends_ = false;
  std::unique_ptr<GlContext> context_;  // made and destroyed on the thread
  std::jthread thread_;
};

}  // namespace merlin::render
