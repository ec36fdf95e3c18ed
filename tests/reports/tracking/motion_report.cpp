// Prints the tables of image motion in docs/measured.md, as Markdown.

#include <cstdio>
#include <vector>

#include "tests/reports/tracking/motion_measures.h"
#include "tests/reports/tracking/pose_measures.h"
#include "tests/reports/tracking/truth_sequence.h"
#include "tests/unit/tracking/desk_sequence.h"

namespace pleinair::tracking {
namespace {

std::vector<MotionSequence> sequences() {
  std::vector<MotionSequence> out;
  if (hasVirtualCamera()) out.push_back(virtualCameraMotion());
  if (hasDeskSequence()) out.push_back(deskMotion());
  if (hasLayers()) out.push_back(layersMotion());
  return out;
}

void reportTrackers(const std::vector<MotionSequence>& all) {
  std::printf(
      "\n### Features and homography\n\n"
      "Errors in px of the frame, median / 95th percentile; × is what they are by what was "
      "predicted, 1 being right.\n\n"
      "| | features a frame | their error | × | frames with a homography | its error | × | cuts | "
      "ms |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const MotionSequence& sequence : all) {
    for (const FeatureMethod method : {FeatureMethod::kLucasKanade, FeatureMethod::kHarrisSift}) {
      const MotionResult found =
          measureMotion(sequence, {.features = method, .flow = false, .staticRegions = false});
      std::printf("| %s, %s | %.0f | %.3f / %.3f | %.2f | %zu of %zu | ", sequence.name.c_str(),
                  method == FeatureMethod::kLucasKanade ? "Lucas-Kanade" : "Harris and SIFT",
                  found.featuresPerFrame, percentile(found.features.actual, 0.5),
                  percentile(found.features.actual, 0.95), found.features.ratio(), found.pictures,
                  found.frames);
      if (found.picture.actual.empty()) {
        std::printf("– | – ");
      } else {
        std::printf("%.3f / %.3f | %.2f ", percentile(found.picture.actual, 0.5),
                    percentile(found.picture.actual, 0.95), found.picture.ratio());
      }
      std::printf("| %zu | %.1f |\n", found.cuts, percentile(found.milliseconds, 0.5));
    }
  }
}

void reportFlow(const std::vector<MotionSequence>& all) {
  std::printf(
      "\n### Dense flow\n\n"
      "Of nodes that are seen in both frames.\n\n"
      "| | all: median / 95th percentile | × | the surest nine tenths | the surest half | with all "
      "else, ms |\n|---|---|---|---|---|---|\n");
  for (const MotionSequence& sequence : all) {
    const MotionResult found = measureMotion(sequence, {});
    const Errors most = found.flow.surest(0.9);
    const Errors half = found.flow.surest(0.5);
    std::printf(
        "| %s | %.3f / %.3f | %.2f | %.3f / %.3f | %.3f / %.3f | %.1f |\n", sequence.name.c_str(),
        percentile(found.flow.actual, 0.5), percentile(found.flow.actual, 0.95), found.flow.ratio(),
        percentile(most.actual, 0.5), percentile(most.actual, 0.95), percentile(half.actual, 0.5),
        percentile(half.actual, 0.95), percentile(found.milliseconds, 0.5));
  }
}

}  // namespace
}  // namespace pleinair::tracking

int main() {
  const auto all = pleinair::tracking::sequences();
  if (all.empty()) {
    std::fprintf(stderr, "motion_report: no sequences in " PLEINAIR_SHARED_DATA "\n");
    return 1;
  }
  pleinair::tracking::reportTrackers(all);
  pleinair::tracking::reportFlow(all);
}
