#include "pipeline/calibration/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/median.h"
#include "pipeline/calibration/lens_uncertainty.h"

namespace pleinair::calibration {
namespace {

constexpr std::size_t kMinViews = 8;
constexpr double kMaxRejectedViews = 1.0 / 3.0;
constexpr double kMaxRmsPx = 0.5;    // at 640×480; larger in larger images
constexpr double kMaxSigmaPx = 1.0;  // at 640×480; larger in larger images
constexpr double kMaxFocalSigma = 0.01;
constexpr double kHeldOutShare = 1.5;
constexpr double kHeldOutPx = 0.1;
constexpr double kMaxOffCentre = 0.15;  // part of the side
constexpr double kMaxAnamorphic = 1.2;  // ratio of fx and fy
constexpr double kMinFocal = 0.2;       // relative to the longer side; 136°
constexpr double kMaxFocal = 30.0;      // relative to the longer side; 2°

double pictureScale(hal::FrameSize size) {
  return std::max(1.0, std::hypot(size.width, size.height) / 800.0);
}

std::string placeName(const glm::dvec2& px, hal::FrameSize size) {
  const double x = px.x / size.width;
  const double y = px.y / size.height;
  const char* across = x < 0.3 ? "left" : x > 0.7 ? "right" : "";
  const char* down = y < 0.3 ? "upper" : y > 0.7 ? "lower" : "";
  if (*across != 0 && *down != 0) return fmt::format("the {} {} corner", down, across);
  if (*across == 0 && *down == 0) return "the middle";
  return fmt::format("the {} side", *across != 0 ? across : down);
}

/// The reasons why images did not become views.
std::string countsText(const ViewCounts& counts) {
  std::vector<std::string> parts;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
  };
  add(counts.pictures - counts.withBoard, "without the whole board");
  add(counts.blurred, "blurred");
  add(counts.moving, "moving");
  add(counts.nothingNew, "showing nothing new");
  return parts.empty() ? "" : fmt::format(" ({})", fmt::join(parts, ", "));
}

Refusal tooFewViews(const ViewSelector& selector, std::size_t usable) {
  const ViewCounts& counts = selector.counts();
  if (counts.withBoard == 0) {
    return {RefusalReason::kNoBoard,
            counts.pictures == 1
                ? std::string("the board is not in the picture")
                : fmt::format("the board is in none of {} pictures", counts.pictures),
            "check --board (a checkerboard counts its inner corners), and light it evenly"};
  }
  if (counts.blurred * 2 > counts.withBoard) {
    return {RefusalReason::kBlurred,
            fmt::format("the board is blurred in {} of the {} pictures that show it: its edges are "
                        "at least {:.1f} px wide; the limit is {:.1f} px",
                        counts.blurred, counts.withBoard, selector.sharpestEdgePx(),
                        selector.widestEdgePx()),
            "focus the camera, give more light, hold the board still"};
  }
  if (counts.moving * 2 > counts.withBoard) {
    return {RefusalReason::kMoving,
            fmt::format("the board moves in {} of the {} pictures that show it, so that rows are "
                        "exposed at different places",
                        counts.moving, counts.withBoard),
            "hold the board still for a second at each place"};
  }
  return {RefusalReason::kTooFewViews,
          fmt::format("only {} of {} pictures {} usable{}, but {} are needed", usable,
                      counts.pictures, usable == 1 ? "is" : "are", countsText(counts), kMinViews),
          "show the board in more places and tilted more ways"};
}

void judgeCoverage(const CalibrationReport& report, std::vector<Refusal>& refusals) {
  const std::vector<std::string> regions = report.coverage.uncoveredRegions();
  if (regions.empty()) return;
  refusals.push_back({RefusalReason::kCoverage,
                      fmt::format("the board was hardly ever in {}", fmt::join(regions, ", ")),
                      "bring the board there, smaller if need be"});
}

void judgeAngles(const LensFit& fit, std::vector<Refusal>& refusals) {
  const LensVector lens = parametersOf(fit.camera);
  const double share = std::max(fit.sigma(0) / lens[0], fit.sigma(1) / lens[1]);
  if (share <= kMaxFocalSigma) return;
  const std::string certainty =
      share < 10.0 ? fmt::format("± {:.1f} %", share * 100.0) : std::string("unknown");
  refusals.push_back(
      {RefusalReason::kSameAngle,
       fmt::format("the views are all at much the same angle, which leaves the focal length open "
                   "(fx {:.0f} px, {})",
                   lens[0], certainty),
       "tilt the board by 30° to each of its four sides"});
}

void judgeErrors(const LensChoice& choice, std::size_t offered, hal::FrameSize size,
                 std::vector<Refusal>& refusals) {
  const double largestRms = kMaxRmsPx * pictureScale(size);
  const std::size_t rejected = offered - choice.usedViews.size();
  constexpr const char* kSoundBoard =
      "glue the board to something flat, measure it, hold it still, lock the focus";
  if (static_cast<double>(rejected) > kMaxRejectedViews * static_cast<double>(offered)) {
    refusals.push_back({RefusalReason::kDisagreement,
                        fmt::format("{} of {} views contradict the others", rejected, offered),
                        kSoundBoard});
  }
  if (choice.fit.rmsPx > largestRms) {
    refusals.push_back({RefusalReason::kLargeError,
                        fmt::format("no lens fits: the error is {:.2f} px RMS; the limit is {:.2f} "
                                    "px",
                                    choice.fit.rmsPx, largestRms),
                        kSoundBoard});
  }
  if (choice.heldOutRmsPx > kHeldOutShare * choice.fit.rmsPx + kHeldOutPx) {
    refusals.push_back(
        {RefusalReason::kHeldOutError,
         fmt::format("views left out of the fit are off by {:.2f} px RMS, fitted ones by "
                     "{:.2f} px",
                     choice.heldOutRmsPx, choice.fit.rmsPx),
         "record more views"});
  }
}

void judgePlausibility(const LensFit& fit, hal::FrameSize size, std::vector<Refusal>& refusals) {
  const LensVector lens = parametersOf(fit.camera);
  const auto refuse = [&](std::string text) {
    refusals.push_back({RefusalReason::kImplausible, std::move(text),
                        "check that the board's squares are square and that the picture is neither "
                        "stretched nor cropped"});
  };
  if (std::abs(lens[2] / size.width - 0.5) > kMaxOffCentre ||
      std::abs(lens[3] / size.height - 0.5) > kMaxOffCentre) {
    refuse(fmt::format("the principal point would be at {:.0f}, {:.0f} in a picture of {}x{}",
                       lens[2], lens[3], size.width, size.height));
  }
  const double ratio = lens[0] / lens[1];
  if (std::max(ratio, 1.0 / ratio) > kMaxAnamorphic) {
    refuse(fmt::format("fx would be {:.2f} times fy", ratio));
  }
  const double focal = lens[0] / std::max(size.width, size.height);
  if (focal < kMinFocal || focal > kMaxFocal) {
    refuse(fmt::format("the focal length would be {:.2f} times the picture's longer side", focal));
  }
}

void judgePlaces(CalibrationReport& report, hal::FrameSize size) {
  const LensFit& fit = report.choice->fit;
  if (foldsInImage(fit.camera)) {
    report.refusals.push_back(
        {RefusalReason::kFoldedLens,
         fmt::format("the distortion ({}) folds back inside of the picture", toString(fit.model)),
         "bring the board to all four corners of the picture"});
    return;
  }
  std::vector<double> sigmas;
  for (const PlaceUncertainty& place : placeUncertainties(fit)) {
    sigmas.push_back(place.sigmaPx);
    if (place.sigmaPx <= report.worstSigmaPx) continue;
    report.worstSigmaPx = place.sigmaPx;
    report.worstPlace = placeName(place.px, size);
  }
  report.typicalSigmaPx = hal::medianOf(sigmas);
  const double largest = kMaxSigmaPx * pictureScale(size);
  if (report.worstSigmaPx <= largest) return;
  report.refusals.push_back(
      {RefusalReason::kUncertainPlaces,
       fmt::format("the lens is known only to {:.1f} px in {}; the limit is {:.1f} px",
                   report.worstSigmaPx, report.worstPlace, largest),
       "bring the board there, tilted"});
}

}  // namespace

CalibrationReport solveCalibration(const ViewSelector& selector, hal::FrameSize size) {
  CalibrationReport report{.coverage = selector.coverage()};
  const std::vector<FitView> views = selector.fitViews();
  if (views.size() < kMinViews) {
    report.refusals.push_back(tooFewViews(selector, views.size()));
    if (!views.empty()) judgeCoverage(report, report.refusals);
    return report;
  }
  report.choice = chooseLens(views, size);
  if (!report.choice) {
    report.refusals.push_back(
        {RefusalReason::kDisagreement,
         fmt::format("the {} views of the board contradict each other", views.size()),
         "check --board, and that the board is flat"});
    return report;
  }
  report.coverage = Coverage();
  for (const std::size_t view : report.choice->usedViews) {
    report.coverage.add(selector.views()[view].traits);
  }
  judgeErrors(*report.choice, views.size(), size, report.refusals);
  judgeAngles(report.choice->fit, report.refusals);
  judgeCoverage(report, report.refusals);
  judgePlausibility(report.choice->fit, size, report.refusals);
  judgePlaces(report, size);
  return report;
}

}  // namespace pleinair::calibration
