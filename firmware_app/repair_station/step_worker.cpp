#include "firmware_app/repair_station/step_worker.h"

#include <exception>
#include <utility>

#include <pthread.h>

namespace pleinair::app {

StepWorker::StepWorker(StepSession session)
    : session_(std::move(session)),
      view_(session_.view()),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

void StepWorker::give(Job job, Failed failed) {
  ++open_;
  const std::scoped_lock lock(mutex_);
  jobs_.push_back({.job = std::move(job), .failed = std::move(failed)});
  changed_.notify_all();
}

StepWorker::Result StepWorker::resultOf(const Given& given) {
  try {
    Then then = given.job(session_);
    return {.view = session_.view(), .then = std::move(then)};
  } catch (const std::exception& error) {
    return {.view = {}, .then = [failed = given.failed, problem = std::string(error.what())] {
              failed(problem);
            }};
  }
}

void StepWorker::work(const std::stop_token& stop) {
  pthread_setname_np(pthread_self(), "record");
  std::unique_lock lock(mutex_);
  // Also after a stop is requested: what is given is done.
  while (changed_.wait(lock, stop, [this] { return !jobs_.empty(); })) {
    const Given given = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    Result result = resultOf(given);
    lock.lock();
    results_.push_back(std::move(result));
    changed_.notify_all();
  }
}

bool StepWorker::poll() {
  for (bool hasTaken = false;; hasTaken = true) {
    std::unique_lock lock(mutex_);
    if (results_.empty()) return hasTaken;
    Result result = std::move(results_.front());
    results_.pop_front();
    lock.unlock();
    --open_;
    if (result.view) view_ = *std::move(result.view);
    if (result.then) result.then();
  }
}

bool StepWorker::finish(hal::Duration patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (open_ > 0) {
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait_until(lock, deadline, [this] { return !results_.empty(); })) return false;
    }
    poll();
  }
  return true;
}

}  // namespace pleinair::app
