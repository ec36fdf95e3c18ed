#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/gates.h"
#include "pipeline/measure/measures.h"

namespace pleinair::measure {

/// The simplest painting: a Voronoi tiling of the screen with one random seed in each square of 8×8
/// px, each tile in the mean colour of its area. It ignores motion, so a measure of coherence must
/// detect it.
class VoronoiTiling {
 public:
  VoronoiTiling(cv::Size size, std::uint64_t seed);

  /// Precondition: the image has the constructor's size.
  cv::Mat3f paint(const cv::Mat3f& picture) const;

 private:
  cv::Mat1i tiles_;  ///< index of the tile of each pixel
  int count_ = 0;
};

/// Subject of a measure: the painting, and on the same frames the controls, whose readings are
/// known in advance and so test the measures.
enum class Subject : std::size_t {
  kPainting,
  kInput,  ///< the input itself
  kFresh,  ///< tiles redrawn at random each frame
  kFixed,  ///< tiles fixed to the screen; DEP is compared with this tiling too
};
inline constexpr std::size_t kSubjects = 4;

/// One value per subject.
template <class Value>
struct PerSubject {
  std::array<Value, kSubjects> values;
  Value& operator[](Subject subject) { return values.at(static_cast<std::size_t>(subject)); }
  const Value& operator[](Subject subject) const {
    return values.at(static_cast<std::size_t>(subject));
  }
};
inline constexpr std::array kAllSubjects{Subject::kPainting, Subject::kInput, Subject::kFresh,
                                         Subject::kFixed};

/// Paints the controls.
class ControlPainter {
 public:
  explicit ControlPainter(cv::Size size);
  /// The image of each subject for a frame; `output` is the painting. `index` counts frames.
  PerSubject<cv::Mat3f> paint(const cv::Mat3f& input, const cv::Mat3f& output,
                              std::uint64_t index) const;

 private:
  VoronoiTiling fixed_;
};

/// Whether the controls read as they must; a control that cannot be evaluated says why. A style
/// without gates is judged by reference gates. `displacedXEw2`: SequenceMeasures::displacedXEw2().
std::vector<Verdict> controlVerdicts(const PerSubject<Measures>& measures,
                                     const styles::CoherenceGates& gates,
                                     const RunConditions& runConditions,
                                     const std::optional<double>& displacedXEw2);

}  // namespace pleinair::measure
