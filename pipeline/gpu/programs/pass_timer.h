#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/handle.h"

namespace pleinair::gpu {

enum class PassTiming {
  kOff,
  /// Timer queries, read frames later without waiting. Real GPUs; they lie on llvmpipe. Runs while
  /// the GPU's clock jumped (GL_GPU_DISJOINT_EXT) are not counted.
  kQueries,
  /// Waits for the GPU before and after each pass. Benchmarks only: it stalls the pipeline.
  kFences,
  /// One frame in PassTimer::kSampledEvery, for products: with queries where the driver has usable
  /// ones, else with fences, which stall that one frame.
  kSampled,
};

/// The time that a pass took so far.
struct PassTime {
  std::string pass;
  std::chrono::nanoseconds total{0};
  std::chrono::nanoseconds last{0};  ///< all its runs of the last timed frame
  std::chrono::nanoseconds peak{0};  ///< the most of a timed frame
  int count = 0;                     ///< runs
  int frames = 0;                    ///< timed frames in which it ran

  /// The mean over the timed frames in which it ran.
  std::chrono::nanoseconds mean() const { return frames == 0 ? total : total / frames; }
};

/// Times passes by name. Programs time their own draws and dispatches (gpu::Program); a scope by
/// hand is for work besides, and programs that run within it count to it. On the thread of the
/// context.
class PassTimer {
 public:
  static constexpr std::uint64_t kSampledEvery = 128;

  /// kQueries falls back to kOff where the driver has none or is software, kSampled to fences.
  explicit PassTimer(PassTiming timing = PassTiming::kOff, const ContextInfo* context = nullptr);

  class Scope {
   public:
    Scope(PassTimer* timer, std::size_t slot) : timer_(timer), slot_(slot) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope() {
      if (timer_ != nullptr) timer_->end(slot_);
    }

   private:
    PassTimer* timer_;
    std::size_t slot_;
  };

  /// Begins another frame. Without, each run counts as a frame of its own, and none is sampled.
  void beginFrame();
  /// Times what is issued while the scope lives. Precondition: no other scope lives.
  [[nodiscard]] Scope measure(std::string_view pass);
  /// Times like measure(); within another scope it times nothing by itself.
  [[nodiscard]] Scope measureWithin(std::string_view pass);
  /// Times of all passes, in the order of first use.
  std::span<const PassTime> times() const { return times_; }
  /// Whether times are the GPU's own; else they are from one fence to the next.
  bool hasQueries() const { return means_ == Means::kQueries; }

 private:
  enum class Means { kNone, kQueries, kFences };
  static constexpr std::size_t kInFlight = 32;  // runs of a pass
  struct Queries {
    std::array<QueryHandle, kInFlight> ring;
    std::array<std::uint64_t, kInFlight> frames{};
    std::size_t issued = 0;
    std::size_t read = 0;
    std::size_t soundFrom = 0;  // earlier ones ran while the GPU's clock jumped
    std::uint64_t frame = 0;    // of the last result
  };

  std::size_t slotOf(std::string_view pass);
  void end(std::size_t slot);
  void collect(std::size_t slot);
  void distrustAfterDisjoint();
  void add(std::size_t slot, std::uint64_t frame, std::chrono::nanoseconds time);

  Means means_;
  bool isSampled_;
  bool isOn_;  // in this frame
  std::uint64_t frame_ = 0;
  std::vector<PassTime> times_;
  std::vector<Queries> queries_;
  bool isMeasuring_ = false;
  std::chrono::steady_clock::time_point began_;
};

}  // namespace pleinair::gpu
