#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "pipeline/runtime/live_pipeline.h"
#include "pipeline/runtime/thread_role.h"

namespace pleinair::runtime {

/// Runs a live chain: the camera thread, the paint thread and an output thread for every output but
/// those that the caller steps itself (docs/architecture.md). Main thread only.
class LiveThreads {
 public:
  /// The paint thread, among those that are stuck.
  static constexpr const char* kPainter = "paint";

  /// Starts the camera thread. The chain outlives this.
  explicit LiveThreads(LivePipeline& chain);
  /// Precondition: stop() has been called, and left nobody behind.
  ~LiveThreads();
  LiveThreads(const LiveThreads&) = delete;
  LiveThreads& operator=(const LiveThreads&) = delete;

  /// Starts the paint thread, which makes the painter.
  void startPainter();
  /// Whether the painter is there; throws what it failed with (hal::Failure).
  bool isPainterReady();
  /// Lets frames flow to the outputs, each on its output thread; `stepped`: which the caller steps
  /// itself.
  void startOutputs(const std::vector<std::size_t>& stepped = {});

  /// Ends the camera, the painter and the outputs in that order, and completes what they write.
  /// Gives what the outputs failed with, apart from those that the caller steps; and, in
  /// `stuck`, the threads that did not end within `patience`: nothing that they use may be
  /// destroyed any more, so that the process has to be left at once.
  struct Stopped {
    std::vector<hal::Error> failures;
    std::vector<std::string> stuck;
  };
  Stopped stop(hal::Duration patience);

 private:
  void launch(const std::string& name, ThreadRole role, std::function<void()> body);
  void runCamera();
  void runPainter();
  void runOutput(OutputStage& output);
  void join(const std::string& name, std::chrono::steady_clock::time_point deadline,
            Stopped& stopped);

  LivePipeline& chain_;
  std::atomic<bool> stopsCamera_ = false;
  std::atomic<bool> stopsPainter_ = false;
  std::atomic<bool> stopsOutputs_ = false;
  std::map<std::string, std::thread> threads_;
  std::vector<std::string> outputNames_;

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::vector<std::string> ended_;
  bool isPainterReady_ = false;
  std::optional<hal::Error> painterFailure_;
  std::vector<hal::Error> failures_;
};

}  // namespace pleinair::runtime
