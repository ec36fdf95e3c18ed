#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace pleinair::gpu {

/// A thread that owns a GL context's life: what is run on it runs there, one at a time, while the
/// caller waits.
class RenderThread {
 public:
  /// Starts the thread; `name` has at most 15 characters.
  explicit RenderThread(const char* name);
  /// Ends it. Nothing may be running.
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  /// Runs `task` on the thread and returns when it is done; an exception of it comes out here. Any
  /// thread but this one; one at a time.
  void run(const std::function<void()>& task);

 private:
  void loop();

  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* task_ = nullptr;
  std::exception_ptr failure_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace pleinair::gpu
