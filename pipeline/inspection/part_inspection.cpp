#include "pipeline/inspection/part_inspection.h"

#include <algorithm>
#include <vector>

#include <glm/trigonometric.hpp>

namespace pleinair::inspection {
namespace {

constexpr double kMaxViewDeg = 12.0;
constexpr double kMinShareInside = 0.97;
constexpr double kMinHalfPx = 20.0;      ///< of the window in the still
constexpr double kMinBrightness = 12.0;  // grey levels
constexpr double kMinStructured = 0.10;  ///< share of the template that has structure

Inspection uncertain(Uncertainty reason, double viewDeg) {
  return {.verdict = Verdict::kUncertain, .reason = reason, .viewDeg = viewDeg, .match = {}};
}

}  // namespace

Verdict verdictOf(const StructureMatch& match) {
  if (match.mean >= kPassMean && match.worst >= kPassWorst) return Verdict::kPass;
  if (match.mean < kFailMean || match.worst < kFailWorst) return Verdict::kFail;
  return Verdict::kUncertain;
}

Inspection inspectPart(const PosedPicture& templatePicture, const PosedPicture& still,
                       const InspectedPart& part) {
  const double viewDeg = glm::degrees(
      viewAngleRad(part.centre, templatePicture.cameraFromModel, still.cameraFromModel));
  if (viewDeg > kMaxViewDeg) {
    return uncertain(Uncertainty::kOtherSide, viewDeg);
  }
  const PartWindow window =
      windowAbout(part.centre, part.radiusMetres, templatePicture.cameraFromModel);
  const WindowPicture expected = windowPicture(window, templatePicture);
  const WindowPicture seen = windowPicture(window, still);
  if (std::min(expected.shareInside, seen.shareInside) < kMinShareInside) {
    return uncertain(Uncertainty::kNotWholly, viewDeg);
  }
  if (seen.halfPx < kMinHalfPx || seen.halfPx < 0.5 * expected.halfPx) {
    return uncertain(Uncertainty::kTooFar, viewDeg);
  }
  StructureSearch search{
      .reliefPx = reliefShiftPx(window, templatePicture.cameraFromModel, still.cameraFromModel)};
  std::vector<ReliefPixel> relief;
  if (!part.triangles.empty()) {
    relief = windowRelief(window, templatePicture.cameraFromModel, part.triangles);
    search.relief = relief;
  }
  const StructureMatch match = matchStructure(expected.luma.view(), seen.luma.view(), search);
  Inspection inspection{.verdict = verdictOf(match), .viewDeg = viewDeg, .match = match};
  if (match.structured < kMinStructured) {
    inspection.verdict = Verdict::kUncertain;
    inspection.reason = Uncertainty::kNothingToCompare;
  } else if (match.brightness < kMinBrightness) {
    inspection.verdict = Verdict::kUncertain;
    inspection.reason = Uncertainty::kTooDark;
  } else if (inspection.verdict == Verdict::kUncertain) {
    inspection.reason = Uncertainty::kAlmostAlike;
  }
  return inspection;
}

}  // namespace pleinair::inspection
