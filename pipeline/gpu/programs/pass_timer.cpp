#include "pipeline/gpu/programs/pass_timer.h"

#include <algorithm>
#include <cassert>

namespace pleinair::gpu {
namespace {

/// A lost GPU shows where the picture is read.
void waitForGpu() {
  (void)Fence::insert().wait();
}

bool hasUsableQueries(const ContextInfo* context) {
  return context != nullptr && context->hasTimerQuery && !context->isSoftware;
}

}  // namespace

PassTimer::PassTimer(PassTiming timing, const ContextInfo* context)
    : means_(Means::kNone),
      isSampled_(timing == PassTiming::kSampled),
      isOn_(timing != PassTiming::kOff && !isSampled_) {
  if (timing == PassTiming::kOff) return;
  const bool wantsFences = timing == PassTiming::kFences;
  if (!wantsFences && hasUsableQueries(context)) {
    means_ = Means::kQueries;
  } else if (timing != PassTiming::kQueries) {
    means_ = Means::kFences;
  } else {
    isOn_ = false;
  }
}

void PassTimer::beginFrame() {
  ++frame_;
  if (!isSampled_) return;
  isOn_ = frame_ % kSampledEvery == 0;
  if (means_ != Means::kQueries || frame_ % kSampledEvery > 1) return;
  for (std::size_t slot = 0; slot < times_.size(); ++slot) collect(slot);
}

std::size_t PassTimer::slotOf(std::string_view pass) {
  const auto found = std::ranges::find(times_, pass, &PassTime::pass);
  if (found != times_.end()) return static_cast<std::size_t>(found - times_.begin());
  times_.push_back({.pass = std::string(pass)});
  queries_.emplace_back();
  return times_.size() - 1;
}

PassTimer::Scope PassTimer::measureWithin(std::string_view pass) {
  if (isMeasuring_) return {nullptr, 0};
  return measure(pass);
}

PassTimer::Scope PassTimer::measure(std::string_view pass) {
  if (!isOn_) return {nullptr, 0};
  assert(!isMeasuring_);
  const std::size_t slot = slotOf(pass);
  if (means_ == Means::kFences) {
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
  queries.frames[queries.issued % kInFlight] = frame_;
  isMeasuring_ = true;
  return {this, slot};
}

void PassTimer::end(std::size_t slot) {
  isMeasuring_ = false;
  if (means_ == Means::kFences) {
    waitForGpu();
    add(slot, frame_, std::chrono::steady_clock::now() - began_);
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
    const std::size_t place = queries.read % kInFlight;
    const GLuint query = queries.ring[place].get();
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return;
    distrustAfterDisjoint();
    GLuint nanoseconds = 0;  // 32 bits hold 4.2 s
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &nanoseconds);
    if (queries.read >= queries.soundFrom) {
      add(slot, queries.frames[place], std::chrono::nanoseconds(nanoseconds));
    }
    ++queries.read;
  }
}

void PassTimer::add(std::size_t slot, std::uint64_t frame, std::chrono::nanoseconds time) {
  PassTime& pass = times_[slot];
  std::uint64_t& lastFrame = queries_[slot].frame;
  const bool isSameFrame = pass.count > 0 && frame != 0 && frame == lastFrame;
  lastFrame = frame;
  pass.last = isSameFrame ? pass.last + time : time;
  pass.peak = std::max(pass.peak, pass.last);
  pass.total += time;
  ++pass.count;
  if (!isSameFrame) ++pass.frames;
}

}  // namespace pleinair::gpu
