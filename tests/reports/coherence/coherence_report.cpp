// Measures OpenCV's filters as `pleinair measure` measures styles. `coherence_report PHOTOGRAPH
// ...`: each photograph is panned by (-1.5, -0.5) px per frame, zoomed by 1 % and rolled by 1°,
// with noise of 2 levels, at 640x480. Takes a minute per photograph and filter.

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/photo.hpp>

#include "pipeline/measure/measurement.h"

namespace pleinair::measure {
namespace {

/// A filter of single frames, without memory.
class FilterPainter final : public MeasuredPainter {
 public:
  using Filter = std::function<void(const cv::Mat& input, cv::Mat& output)>;
  explicit FilterPainter(Filter filter) : filter_(std::move(filter)) {}

  hal::Result<PaintedFrame> paint(const hal::CapturedFrame& frame) override {
    PaintedFrame painted{.input = hal::Image(frame.image), .output = {}, .anchors = {}};
    painted.output = painted.input;
    const hal::FrameSize size = painted.input.size();
    const cv::Mat input(size.height, size.width, CV_8UC3, painted.input.plane(0).data());
    cv::Mat output;
    filter_(input, output);
    output.copyTo(cv::Mat(size.height, size.width, CV_8UC3, painted.output.plane(0).data()));
    return painted;
  }
  void reset() override {}

 private:
  Filter filter_;
};

struct NamedFilter {
  const char* name;
  FilterPainter::Filter filter;
};

std::vector<NamedFilter> filters() {
  return {
      {"OpenCV stylization",
       [](const cv::Mat& input, cv::Mat& output) { cv::stylization(input, output); }},
      {"OpenCV edgePreservingFilter",
       [](const cv::Mat& input, cv::Mat& output) { cv::edgePreservingFilter(input, output); }},
      {"OpenCV pencilSketch",
       [](const cv::Mat& input, cv::Mat& output) {
         cv::Mat grey;
         cv::pencilSketch(input, grey, output);
       }},
  };
}

void report(const std::string& photograph, const PhotographMotion& motion,
            const NamedFilter& filter) {
  constexpr std::uint64_t kFrames = 30;
  const auto input = hal::orThrow(openPhotograph(
      photograph, {.size = hal::FrameSize{640, 480}, .motion = motion, .frames = kFrames}));
  FilterPainter painter(filter.filter);
  const auto measured = hal::orThrow(measure(
      *input, painter, {.style = filter.name, .settings = "its own defaults", .stillSettle = 0}));
  std::puts(reportText(*measured).c_str());
  std::fflush(stdout);  // the next line takes minutes
}

}  // namespace
}  // namespace pleinair::measure

int main(int argc, char** argv) {
  using namespace pleinair::measure;
  const std::vector<std::string> photographs(argv + 1, argv + argc);
  try {
    for (const std::string& photograph : photographs) {
      for (const NamedFilter& filter : filters()) {
        report(photograph, {.pan = {-1.5, -0.5}}, filter);
        report(photograph, {.zoomPercent = 1}, filter);
        report(photograph, {.rollDegrees = 1}, filter);
      }
    }
  } catch (const pleinair::hal::Failure& error) {
    std::fprintf(stderr, "coherence_report: %s\n", error.what());
    return 2;
  }
  return 0;
}
