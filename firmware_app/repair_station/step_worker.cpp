#include "firmware_app/repair_station/step_worker.h"

#include <utility>

#include <pthread.h>

namespace pleinair::app {

StepWorker::StepWorker(StepSession session)
    : session_(std::move(session)),
      view_(session_.view()),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

void StepWorker::give(Job job) {
  ++open_;
  const std::scoped_lock lock(mutex_);
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void StepWorker::work(const std::stop_token& stop) {
  pthread_setname_np(pthread_self(), "record");
  std::unique_lock lock(mutex_);
  // Also after a stop is requested: what is given is done.
  while (changed_.wait(lock, stop, [this] { return !jobs_.empty(); })) {
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    Then then = job(session_);
    Result result{.view = session_.view(), .then = std::move(then)};
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
    view_ = std::move(result.view);
    if (result.then) result.then();
  }
}

void StepWorker::finish() {
  while (open_ > 0) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !results_.empty(); });
    }
    poll();
  }
}

}  // namespace pleinair::app
