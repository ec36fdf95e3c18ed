#include "pipeline/inspection/part_inspection.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

namespace pleinair::inspection {
namespace {

constexpr double kMaxViewDeg = 12.0;
constexpr double kMinShareInside = 0.97;
constexpr double kMinHalfPx = 20.0;      ///< of the window in the still
constexpr double kMinBrightness = 12.0;  // grey levels
constexpr double kMinStructured = 0.10;  ///< share of the template that has structure

Inspection uncertain(std::string reason) {
  return {.verdict = Verdict::kUncertain, .reason = std::move(reason), .match = {}};
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
    return uncertain(fmt::format("look from where the template was taken: {:.0f}° off", viewDeg));
  }
  const PartWindow window =
      windowAbout(part.centre, part.radiusMetres, templatePicture.cameraFromModel);
  const WindowPicture expected = windowPicture(window, templatePicture);
  const WindowPicture seen = windowPicture(window, still);
  if (std::min(expected.shareInside, seen.shareInside) < kMinShareInside) {
    return uncertain("the part is not wholly in the picture");
  }
  if (seen.halfPx < kMinHalfPx || seen.halfPx < 0.5 * expected.halfPx) {
    return uncertain("come closer");
  }
  StructureSearch search{
      .reliefPx = reliefShiftPx(window, templatePicture.cameraFromModel, still.cameraFromModel)};
  std::vector<ReliefPixel> relief;
  if (!part.triangles.empty()) {
    relief = windowRelief(window, templatePicture.cameraFromModel, part.triangles);
    search.relief = relief;
  }
  const StructureMatch match = matchStructure(expected.luma.view(), seen.luma.view(), search);
  Inspection inspection{.verdict = verdictOf(match), .reason = {}, .match = match};
  if (match.structured < kMinStructured) {
    inspection.verdict = Verdict::kUncertain;
    inspection.reason = "the template shows nothing to compare: take another one";
  } else if (match.brightness < kMinBrightness) {
    inspection.verdict = Verdict::kUncertain;
    inspection.reason = "the picture is too dark";
  } else if (inspection.verdict == Verdict::kUncertain) {
    inspection.reason = "almost alike: look for yourself";
  }
  return inspection;
}

}  // namespace pleinair::inspection
