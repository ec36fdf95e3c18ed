#include "pipeline/runtime/live_threads.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pleinair::runtime {
namespace {

constexpr const char* kCamera = "camera";
/// How long the camera may be asked at a time: how late its thread notices the end.
constexpr hal::Duration kCameraLook = std::chrono::milliseconds(100);

}  // namespace

LiveThreads::LiveThreads(LivePipeline& chain) : chain_(chain) {
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
  while (!stopsCamera_) chain_.capture().step(chain_.clock().now() + kCameraLook);
  chain_.capture().step(chain_.clock().now());  // closes it: stop() was asked for
}

void LiveThreads::startPainter() {
  launch(kPainter, ThreadRole::kOrdinary, [this] { runPainter(); });
}

void LiveThreads::runPainter() {
  try {
    chain_.paint().start();
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
    if (!chain_.paint().step()) chain_.paint().wait();
  }
  chain_.paint().stop();
}

bool LiveThreads::isPainterReady() {
  const std::scoped_lock lock(mutex_);
  if (painterFailure_) throw hal::Failure(*painterFailure_);
  return isPainterReady_;
}

void LiveThreads::startOutputs(const std::vector<std::size_t>& stepped) {
  for (std::size_t i = 0; i < chain_.outputCount(); ++i) {
    if (std::ranges::find(stepped, i) != stepped.end()) continue;
    OutputStage& output = chain_.output(i);
    outputNames_.push_back("output " + std::to_string(i));
    // Files are encoded on their thread, which is not to be in the way of others.
    const ThreadRole role = output.isPaced() ? ThreadRole::kPrompt : ThreadRole::kOrdinary;
    launch(outputNames_.back(), role, [this, &output] { runOutput(output); });
  }
  chain_.capture().open();
}

void LiveThreads::runOutput(OutputStage& output) {
  while (!stopsOutputs_) output.wait(output.step());
  if (auto finished = output.finish(); !finished) {
    const std::scoped_lock lock(mutex_);
    failures_.push_back(std::move(finished.error()));
  }
}

void LiveThreads::join(const std::string& name, std::chrono::steady_clock::time_point deadline,
                       Stopped& stopped) {
  const auto thread = threads_.find(name);
  if (thread == threads_.end()) return;
  {
    std::unique_lock lock(mutex_);
    const auto hasEnded = [&] { return std::ranges::find(ended_, name) != ended_.end(); };
    if (!changed_.wait_until(lock, deadline, hasEnded)) {
      stopped.stuck.push_back(name);
      return;
    }
  }
  thread->second.join();
  threads_.erase(thread);
}

LiveThreads::Stopped LiveThreads::stop(hal::Duration patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  Stopped stopped;
  stopsCamera_ = true;
  chain_.camera().stop();
  // A camera that does not let go must not keep the others from ending in order.
  join(kCamera, deadline - patience / 2, stopped);
  stopsPainter_ = true;
  if (threads_.contains(kPainter)) chain_.paint().wake();
  join(kPainter, deadline - patience / 4, stopped);
  stopsOutputs_ = true;
  for (std::size_t i = 0; i < chain_.outputCount(); ++i) chain_.output(i).wake();
  for (const std::string& name : outputNames_) join(name, deadline, stopped);
  // What was not waited for long enough, for the others' sake.
  for (const std::string& name : std::exchange(stopped.stuck, {})) join(name, deadline, stopped);
  const std::scoped_lock lock(mutex_);
  stopped.failures = failures_;
  return stopped;
}

}  // namespace pleinair::runtime
