#pragma once

#include <opencv2/core/utility.hpp>

namespace pleinair::tracking {

/// Runs `body(i)` for each i below `count` on OpenCV's threads. Avoids cv::parallel_for_() with a
/// lambda: it wraps the lambda in a std::function, which allocates at each call.
template <class Body>
void parallelFor(int count, const Body& body) {
  class Loop final : public cv::ParallelLoopBody {
   public:
    explicit Loop(const Body& each) : each_(each) {}
    void operator()(const cv::Range& range) const override {
      for (int i = range.start; i < range.end; ++i) each_(i);
    }

   private:
    const Body& each_;
  };
  cv::parallel_for_({0, count}, Loop(body));
}

}  // namespace pleinair::tracking
