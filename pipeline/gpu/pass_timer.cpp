#include "pipeline/gpu/pass_timer.h"

#include <algorithm>
#include <cassert>

namespace pleinair::gpu {
namespace {

/// Whoever reads the picture meets a lost GPU.
void waitForGpu() {
  (void)Fence::insert().wait();
}

PassTiming possible(PassTiming wanted, const ContextInfo* context) {
  if (wanted != PassTiming::kQueries) return wanted;
  const bool usable = context != nullptr && context->hasTimerQuery && !context->isSoftware;
  return usable ? wanted : PassTiming::kOff;
}

}  // namespace

PassTimer::PassTimer(PassTiming timing, const ContextInfo* context)
    : timing_(possible(timing, context)) {}

std::size_t PassTimer::slotOf(std::string_view pass) {
  const auto found = std::ranges::find(times_, pass, &PassTime::pass);
  if (found != times_.end()) return static_cast<std::size_t>(found - times_.begin());
  times_.push_back({.pass = std::string(pass)});
  queries_.emplace_back();
  return times_.size() - 1;
}

PassTimer::Scope PassTimer::measure(std::string_view pass) {
  if (timing_ == PassTiming::kOff) return {nullptr, 0};
  assert(!isMeasuring_);
  const std::size_t slot = slotOf(pass);
  if (timing_ == PassTiming::kFences) {
    waitForGpu();
    isMeasuring_ = true;
    began_ = std::chrono::steady_clock::now();
    return {this, slot};
  }
  collect(slot);
  Queries& queries = queries_[slot];
  if (queries.issued - queries.read == kInFlight) return {nullptr, 0};  // this one goes untimed
  QueryHandle& query = queries.ring[queries.issued % kInFlight];
  if (!query) query = QueryHandle::make();
  glBeginQuery(GL_TIME_ELAPSED_EXT, query.get());
  isMeasuring_ = true;
  return {this, slot};
}

void PassTimer::end(std::size_t slot) {
  isMeasuring_ = false;
  if (timing_ == PassTiming::kFences) {
    waitForGpu();
    add(slot, std::chrono::steady_clock::now() - began_);
    return;
  }
  glEndQuery(GL_TIME_ELAPSED_EXT);
  ++queries_[slot].issued;
}

/// Reading the flag clears it, so every query that is in flight is marked at once.
void PassTimer::distrustAfterDisjoint() {
  GLint disjoint = GL_FALSE;
  glGetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
  if (disjoint == GL_FALSE) return;
  for (Queries& queries : queries_) queries.soundFrom = queries.issued;
}

void PassTimer::collect(std::size_t slot) {
  Queries& queries = queries_[slot];
  while (queries.read < queries.issued) {
    const GLuint query = queries.ring[queries.read % kInFlight].get();
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return;
    distrustAfterDisjoint();
    GLuint nanoseconds = 0;  // 32 bits hold 4.2 s
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &nanoseconds);
    if (queries.read >= queries.soundFrom) add(slot, std::chrono::nanoseconds(nanoseconds));
    ++queries.read;
  }
}

void PassTimer::add(std::size_t slot, std::chrono::nanoseconds time) {
  times_[slot].last = time;
  times_[slot].total += time;
  ++times_[slot].count;
}

}  // namespace pleinair::gpu
