#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <memory>
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

/// The threads of a live pipeline: the camera thread, the paint thread, and an output thread for
/// each output that the caller does not step itself (docs/architecture.md). Main thread only.
class LiveThreads {
 public:
  /// The name of the paint thread in Stopped::stuck.
  static constexpr const char* kPainter = "paint";

  /// Starts the camera thread. The pipeline outlives this.
  explicit LiveThreads(LivePipeline& pipeline);
  /// Precondition: stop() has been called, and no thread was stuck.
  ~LiveThreads();
  LiveThreads(const LiveThreads&) = delete;
  LiveThreads& operator=(const LiveThreads&) = delete;

  /// Starts the paint thread, which makes the painter.
  void startPainter();
  /// Whether the painter is ready. Throws hal::Failure if it could not be made.
  bool isPainterReady();
  /// Starts an output's thread before the others', for waiting pictures. Precondition:
  /// startOutputs() has not been called.
  void startOutput(OutputStage& output);
  /// Starts a thread for each other output except those in `stepped`, which the caller steps
  /// itself, and lets frames flow.
  void startOutputs(const std::vector<const OutputStage*>& stepped = {});

  /// Adds an output to the pipeline while frames flow, and starts its thread. `output` was started
  /// and answered `format`. Precondition: startOutputs() has been called, stop() has not.
  OutputStage& addOutput(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                         OutputStageOptions options);
  /// Ends an output and its thread, while painting and the other outputs go on: once the painter
  /// has let go of it, what is due is handed over, the rest ends as kStopped, and what the output
  /// writes is completed. Returns at once; takeRemoved() gives the output when that is done.
  /// Precondition: the output has a thread, and was not removed before.
  void removeOutput(OutputStage& output);
  struct Removed {
    std::unique_ptr<OutputStage> output;  ///< finished
    std::optional<hal::Error> failure;    ///< the error of finishing it
  };
  /// A removed output whose thread has ended; nothing if there is none within `patience` of real
  /// time. Removed outputs that nobody has taken at stop() are ended there like the others.
  std::optional<Removed> takeRemoved(hal::Duration patience = hal::Duration{0});

  struct Stopped {
    std::vector<hal::Error> failures;  ///< errors of outputs that have a thread here
    /// Threads that did not end in time. Nothing that they use may be destroyed any more, so the
    /// process has to exit without destroying it.
    std::vector<std::string> stuck;
  };
  /// Ends the camera, the painter and the outputs in that order, and completes what the outputs
  /// write; waits for at most `patience` of real time. Another call waits again for stuck threads.
  Stopped stop(hal::Duration patience);

 private:
  struct OutputThread {
    std::string name;
    OutputStage* output = nullptr;
    std::atomic<bool> isRemoved = false;
    std::optional<hal::Error> failure;  ///< guarded by mutex_
  };
  void launch(const std::string& name, ThreadRole role, std::function<void()> body);
  std::string nextOutputName();
  void launchOutput(const std::string& name, OutputStage& output);
  void runCamera();
  void runPainter();
  void runOutput(OutputThread& thread);
  bool mayEnd(const OutputThread& thread) const;
  bool hasEnded(const std::string& name) const;
  void join(const std::string& name, std::chrono::steady_clock::time_point deadline,
            Stopped& stopped);

  LivePipeline& pipeline_;
  std::atomic<bool> stopsCamera_ = false;
  std::atomic<bool> stopsPainter_ = false;
  std::atomic<bool> stopsOutputs_ = false;
  std::map<std::string, std::thread> threads_;
  std::list<OutputThread> outputThreads_;  ///< a list: threads refer to their entries
  std::size_t nextOutput_ = 0;             ///< number of the next output of the pipeline

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::vector<std::string> ended_;  ///< names of threads that have ended and were not joined
  bool isPainterReady_ = false;
  std::optional<hal::Error> painterFailure_;
};

}  // namespace pleinair::runtime
