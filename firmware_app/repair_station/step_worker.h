#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "firmware_app/repair_station/step_session.h"
#include "hal/clock.h"

namespace pleinair::app {

/// A thread that writes a record: codes stills, waits for the disk, compares pictures, reads
/// procedures. Jobs are done one after the other, in the order in which they were given, so the
/// record has their lines in that order. All calls from one thread, which this does not keep.
class StepWorker {
 public:
  /// What is done with a result, on the thread that polls.
  using Then = std::function<void()>;
  /// On the worker's thread. Null: nothing follows.
  using Job = std::function<Then(StepSession&)>;
  /// What follows where the job threw a std::exception, with its text; on the thread that polls.
  using Failed = std::function<void(const std::string& problem)>;

  explicit StepWorker(StepSession session);
  /// Does the jobs that are left, so that what was answered is in the record; nothing follows them.
  ~StepWorker() = default;
  StepWorker(const StepWorker&) = delete;
  StepWorker& operator=(const StepWorker&) = delete;

  void give(Job job, Failed failed);
  /// Takes the results that are there, in order; whether there were some.
  bool poll();
  /// Waits until all jobs are done, those too that follow, and takes their results; at most for
  /// `patience` of real time. Returns whether they are done: else the thread still uses this.
  bool finish(hal::Duration patience = std::chrono::hours(1));
  /// The number of jobs that were given and whose results were not taken.
  std::size_t open() const { return open_; }
  /// As the results that were taken left it.
  const SessionView& view() const { return view_; }

 private:
  struct Given {
    Job job;
    Failed failed;
  };
  struct Result {
    std::optional<SessionView> view;  ///< unset: as before
    Then then;
  };
  Result resultOf(const Given& given);
  void work(const std::stop_token& stop);

  StepSession session_;  ///< the thread's
  SessionView view_;
  std::size_t open_ = 0;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Given> jobs_;      ///< under mutex_
  std::deque<Result> results_;  ///< under mutex_
  std::jthread thread_;         ///< the last member: it uses all others
};

}  // namespace pleinair::app
