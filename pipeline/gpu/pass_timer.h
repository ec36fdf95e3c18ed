#pragma once

#include <array>
#include <chrono>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/gpu/egl_context.h"
#include "pipeline/gpu/handle.h"

namespace pleinair::gpu {

enum class PassTiming {
  kOff,
  /// Timer queries, read frames later without waiting. Real GPUs; they lie on llvmpipe. What ran
  /// while the GPU's clock jumped (GL_GPU_DISJOINT_EXT) is not counted.
  kQueries,
  /// Waits for the GPU before and after each pass. Benchmarks only: it stalls the pipeline.
  kFences,
};

/// What a pass took so far.
struct PassTime {
  std::string pass;
  std::chrono::nanoseconds total{0};
  std::chrono::nanoseconds last{0};
  int count = 0;
};

/// Times passes by name. Scopes may not nest. On the thread of the context.
class PassTimer {
 public:
  /// kQueries falls back to kOff where the driver has none or is software.
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

  /// Times what is issued while the scope lives.
  [[nodiscard]] Scope measure(std::string_view pass);
  /// In the order of first use.
  std::span<const PassTime> times() const { return times_; }

 private:
  static constexpr std::size_t kInFlight = 4;
  struct Queries {
    std::array<QueryHandle, kInFlight> ring;
    std::size_t issued = 0;
    std::size_t read = 0;
    std::size_t soundFrom = 0;  // earlier ones ran while the GPU's clock jumped
  };

  std::size_t slotOf(std::string_view pass);
  void end(std::size_t slot);
  void collect(std::size_t slot);
  void distrustAfterDisjoint();
  void add(std::size_t slot, std::chrono::nanoseconds time);

  PassTiming timing_;
  std::vector<PassTime> times_;
  std::vector<Queries> queries_;
  bool isMeasuring_ = false;
  std::chrono::steady_clock::time_point began_;
};

}  // namespace pleinair::gpu
