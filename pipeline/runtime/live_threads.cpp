#include "pipeline/runtime/live_threads.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pleinair::runtime {
namespace {

constexpr const char* kCamera = "camera";
/// Longest wait for the camera at a time: by as much its thread may be late to notice stop().
constexpr hal::Duration kMaxCameraWait = std::chrono::milliseconds(100);

}  // namespace

LiveThreads::LiveThreads(LivePipeline& pipeline) : pipeline_(pipeline) {
  launch(kCamera, ThreadRole::kPrompt, [this] { runCamera(); });
}

LiveThreads::~LiveThreads() {
  assert(threads_.empty());
}

void LiveThreads::launch(const std::string& name, ThreadRole role, std::function<void()> body) {
  threads_.emplace(name, std::thread([this, name, role, body = std::move(body)] {
                     setThreadRole(name, role);
                     body();
                     const std::scoped_lock lock(mutex_);
                     ended_.push_back(name);
                     changed_.notify_all();
                   }));
}

void LiveThreads::runCamera() {
  while (!stopsCamera_) pipeline_.capture().step(pipeline_.clock().now() + kMaxCameraWait);
  pipeline_.capture().step(pipeline_.clock().now());  // the supervisor, stopped, closes the camera
}

void LiveThreads::startPainter() {
  launch(kPainter, ThreadRole::kOrdinary, [this] { runPainter(); });
}

void LiveThreads::runPainter() {
  try {
    pipeline_.paint().start();
  } catch (const hal::Failure& error) {
    const std::scoped_lock lock(mutex_);
    painterFailure_ = error.error();
    return;
  }
  {
    const std::scoped_lock lock(mutex_);
    isPainterReady_ = true;
  }
  while (!stopsPainter_) {
    if (!pipeline_.paint().step()) pipeline_.paint().wait();
  }
  pipeline_.paint().stop();
}

bool LiveThreads::isPainterReady() {
  const std::scoped_lock lock(mutex_);
  if (painterFailure_) throw hal::Failure(*painterFailure_);
  return isPainterReady_;
}

void LiveThreads::startOutput(OutputStage& output) {
  launchOutput(nextOutputName(), output);
}

void LiveThreads::startOutputs(const std::vector<const OutputStage*>& stepped) {
  for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) {
    OutputStage& output = pipeline_.output(i);
    if (std::ranges::find(outputThreads_, &output, &OutputThread::output) != outputThreads_.end()) {
      continue;
    }
    const std::string name = nextOutputName();
    if (std::ranges::find(stepped, &output) == stepped.end()) launchOutput(name, output);
  }
  pipeline_.capture().open();
}

OutputStage& LiveThreads::addOutput(std::unique_ptr<hal::Output> output, hal::OutputFormat format,
                                    OutputStageOptions options) {
  assert(!stopsOutputs_);
  OutputStage& added = pipeline_.addOutput(std::move(output), format, std::move(options));
  launchOutput(nextOutputName(), added);
  return added;
}

std::string LiveThreads::nextOutputName() {
  return "output " + std::to_string(nextOutput_++);
}

void LiveThreads::launchOutput(const std::string& name, OutputStage& output) {
  OutputThread& thread = outputThreads_.emplace_back();
  thread.name = name;
  thread.output = &output;
  // Files are encoded on their output threads, which must not delay the others.
  const ThreadRole role = output.isPaced() ? ThreadRole::kPrompt : ThreadRole::kOrdinary;
  launch(thread.name, role, [this, &thread] { runOutput(thread); });
}

bool LiveThreads::mayEnd(const OutputThread& thread) const {
  return stopsOutputs_ || (thread.isRemoved && pipeline_.hasReleased(*thread.output));
}

void LiveThreads::runOutput(OutputThread& thread) {
  while (!mayEnd(thread)) thread.output->wait(thread.output->step());
  if (auto finished = thread.output->finish(); !finished) {
    const std::scoped_lock lock(mutex_);
    thread.failure = std::move(finished.error());
  }
}

void LiveThreads::removeOutput(OutputStage& output) {
  const auto thread = std::ranges::find(outputThreads_, &output, &OutputThread::output);
  assert(thread != outputThreads_.end() && !thread->isRemoved);
  pipeline_.removeOutput(output);
  thread->isRemoved = true;  // after the request, which hasReleased() answers
  output.wake();
}

std::optional<LiveThreads::Removed> LiveThreads::takeRemoved(hal::Duration patience) {
  const auto isDone = [this](const OutputThread& thread) {
    return thread.isRemoved && threads_.contains(thread.name) && hasEnded(thread.name);
  };
  auto done = outputThreads_.end();
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] {
      done = std::ranges::find_if(outputThreads_, isDone);
      return done != outputThreads_.end();
    });
  }
  if (done == outputThreads_.end()) return std::nullopt;
  Stopped joined;
  join(done->name, std::chrono::steady_clock::now(), joined);
  assert(joined.stuck.empty());
  Removed removed{.output = pipeline_.takeRemoved(*done->output),
                  .failure = std::move(done->failure)};
  assert(removed.output);
  outputThreads_.erase(done);
  return removed;
}

/// Precondition: the mutex is held.
bool LiveThreads::hasEnded(const std::string& name) const {
  return std::ranges::find(ended_, name) != ended_.end();
}

void LiveThreads::join(const std::string& name, std::chrono::steady_clock::time_point deadline,
                       Stopped& stopped) {
  const auto thread = threads_.find(name);
  if (thread == threads_.end()) return;
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_until(lock, deadline, [&] { return hasEnded(name); })) {
      stopped.stuck.push_back(name);
      return;
    }
    std::erase(ended_, name);
  }
  thread->second.join();
  threads_.erase(thread);
}

LiveThreads::Stopped LiveThreads::stop(hal::Duration patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  Stopped stopped;
  stopsCamera_ = true;
  pipeline_.camera().stop();
  // A camera that does not let go must not keep the others from ending in order.
  join(kCamera, deadline - patience / 2, stopped);
  stopsPainter_ = true;
  if (threads_.contains(kPainter)) pipeline_.paint().wake();
  join(kPainter, deadline - patience / 4, stopped);
  stopsOutputs_ = true;
  for (std::size_t i = 0; i < pipeline_.outputCount(); ++i) pipeline_.output(i).wake();
  for (const OutputThread& thread : outputThreads_) join(thread.name, deadline, stopped);
  // Threads that got only a share of the patience get the rest of it.
  for (const std::string& name : std::exchange(stopped.stuck, {})) join(name, deadline, stopped);
  const std::scoped_lock lock(mutex_);
  for (const OutputThread& thread : outputThreads_) {
    if (thread.failure) stopped.failures.push_back(*thread.failure);
  }
  return stopped;
}

}  // namespace pleinair::runtime
