#include "pipeline/gpu/render_thread.h"

#include <cassert>
#include <utility>

#include <pthread.h>

namespace pleinair::gpu {

RenderThread::RenderThread(const char* name) : thread_([this] { loop(); }) {
  [[maybe_unused]] const int failed = pthread_setname_np(thread_.native_handle(), name);
  assert(failed == 0);  // too long
}

RenderThread::~RenderThread() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void RenderThread::run(const std::function<void()>& task) {
  assert(std::this_thread::get_id() != thread_.get_id());
  std::unique_lock lock(mutex_);
  assert(task_ == nullptr);
  task_ = &task;
  changed_.notify_all();
  changed_.wait(lock, [this] { return task_ == nullptr; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void RenderThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return task_ != nullptr || stopping_; });
    if (task_ == nullptr) return;
    lock.unlock();
    std::exception_ptr failure;
    try {
      (*task_)();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    task_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace pleinair::gpu
