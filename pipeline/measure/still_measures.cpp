#include "pipeline/measure/still_measures.h"

#include <utility>

#include "pipeline/measure/departure.h"

namespace pleinair::measure {

void StillMeasures::add(const cv::Mat3f& input, const cv::Mat3f& output) {
  PerSubject<cv::Mat3f> pictures = controls_.paint(input, output, frames_);
  for (const Subject subject : kAllSubjects) {
    if (frames_ > 0) flickers_[subject] += absoluteDifference(last_[subject], pictures[subject]);
  }
  last_ = std::move(pictures);
  ++frames_;
}

std::optional<double> StillMeasures::flicker(Subject subject) const {
  return ratio(flickers_[subject].value(), flickers_[Subject::kInput].value());
}

}  // namespace pleinair::measure
