#include "pipeline/measure/mover_gates.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "hal/clock.h"
#include "pipeline/measure/limit_verdict.h"
#include "pipeline/measure/mover_masks.h"

namespace pleinair::measure {
namespace {

constexpr double kMaxStillPercent = 0.2;
constexpr double kMaxFollow = 0.25;
constexpr double kMaxReturnLevels = 4.0;
constexpr double kMaxGhost = 0.25;
constexpr double kMaxLostPercent = 15.0;
constexpr double kMaxRemainsPercent = 2.0;
constexpr double kMaxMoverNHw2 = 0.25;
constexpr double kMaxMoverPopPercent = 2.0;
constexpr double kMaxSeamPopPercent = 3.0;
constexpr double kMaxLinePopPercent = 5.0;
constexpr double kMaxLineSeamPopPercent = 10.0;
constexpr double kMaxFlipsPercent = 0.0;
constexpr double kMaxDisplacedIou = 0.8;
constexpr std::uint64_t kDetectionFrames = 3;
constexpr hal::Duration kDetectionTime = std::chrono::milliseconds(100);

constexpr const char* kNothingUncovered = "no mover came and went";
constexpr const char* kNoClearMover = "no mover came that differs from the ground";
constexpr const char* kNothingFollowed = "no mover was seen for three frames";
constexpr const char* kNoMover = "no mover was seen";
constexpr const char* kNothingStill = "movers, or light that changes, are everywhere";

constexpr Limit kStillLimit{"STILL", " %", kMaxStillPercent, kNothingStill};
constexpr Limit kFollowLimit{"FOLLOW", "", kMaxFollow, "no light changed at once"};
constexpr Limit kReturnLimit{"RETURN", "", kMaxReturnLevels, kNothingUncovered};
constexpr Limit kGhostLimit{"GHOST", "", kMaxGhost, kNothingUncovered};
constexpr Limit kLostLimit{"LOST", " %", kMaxLostPercent, kNoClearMover};
constexpr Limit kRemainsLimit{"REMAINS", " %", kMaxRemainsPercent, kNoMover};
constexpr Limit kMoverNHw2Limit{"MOVER nHW2", "", kMaxMoverNHw2, kNothingFollowed};
constexpr Limit kMoverPopLimit{"MOVER POP", " %", kMaxMoverPopPercent, kNothingFollowed};
constexpr Limit kSeamPopLimit{"SEAM POP", " %", kMaxSeamPopPercent, kNothingFollowed};
constexpr Limit kLinePopLimit{"smoothed MOVER POP", " %", kMaxLinePopPercent, kNothingFollowed};
constexpr Limit kLineSeamPopLimit{"smoothed SEAM POP", " %", kMaxLineSeamPopPercent,
                                  kNothingFollowed};
constexpr Limit kAveragingLost{"LOST of a painter that averages over 0.65 s", " %", kMaxLostPercent,
                               kNoClearMover, false};

constexpr Limit kAveragingFollow{"FOLLOW of a painter that averages over 0.65 s", "", kMaxFollow,
                                 "no light changed at once", false};

static_assert(kDisplacementPixels == 20, "the names of these controls say it");
constexpr Limit kDisplacedStill{
    "the input's pixels that change more under masks displaced by 20 px", " %", kMaxStillPercent,
    kNoMover, false};
constexpr Limit kDisplacedIouLimit{"IoU of masks displaced by 20 px", "", kMaxDisplacedIou,
                                   "no mover of noticeable size"};

constexpr Limit kFlipsLimit{"labels that flip where nothing moves", " %", kMaxFlipsPercent,
                            "fewer than two frames"};
constexpr Limit kStillFlipsLimit{"labels that flip on the still scene", " %", kMaxFlipsPercent,
                                 "no still scene"};

std::vector<Verdict> verdictsAlong(const MoverMotionSummary& painting,
                                   const MoverMotionSummary& input, bool areLines) {
  if (areLines) {
    return {
        verdictAlong(kMoverNHw2Limit, painting.nHw2, input.nHw2),
        verdictAlong(kLinePopLimit, painting.smoothPopPercent, input.smoothPopPercent),
        verdictAlong(kLineSeamPopLimit, painting.smoothSeamPopPercent, input.smoothSeamPopPercent)};
  }
  return {verdictAlong(kMoverNHw2Limit, painting.nHw2, input.nHw2),
          verdictAlong(kMoverPopLimit, painting.popPercent, input.popPercent),
          verdictAlong(kSeamPopLimit, painting.seamPopPercent, input.seamPopPercent)};
}

/// Marks that are redrawn in each frame have to fail at least one of the gates along the motion.
Verdict redrawnVerdict(const MoverMotionSummary& redrawn, const MoverMotionSummary& input,
                       bool areLines) {
  Verdict verdict{.what = "marks redrawn each frame fail MOVER nHW2, MOVER POP or SEAM POP",
                  .found = kNothingFollowed};
  const std::vector<Verdict> gates = verdictsAlong(redrawn, input, areLines);
  if (std::ranges::all_of(gates, [](const Verdict& gate) { return !gate.comparison->value; })) {
    verdict.found = gates.front().found;
    return verdict;
  }
  verdict.state = Verdict::State::kFailed;
  verdict.found = "they pass; movers are too plain";
  for (const Verdict& gate : gates) {
    if (gate.state != Verdict::State::kFailed) continue;
    verdict.found = verdict.state == Verdict::State::kPassed ? verdict.found + ", " : "";
    verdict.found += fmt::format("{} fails with {}", gate.what, gate.found);
    verdict.state = Verdict::State::kPassed;
  }
  return verdict;
}

bool isLate(const Detection& detection) {
  return !detection.isFound ||
         (detection.frames > kDetectionFrames && detection.time > kDetectionTime);
}

Verdict detectionVerdict(const std::vector<Detection>& detections) {
  const auto slowest = std::ranges::max_element(
      detections, {}, [](const Detection& each) { return std::pair(isLate(each), each.frames); });
  Verdict verdict{
      .what = fmt::format("frames until a new mover is labelled ≤ {}, or 100 ms", kDetectionFrames),
      .found = "no mover came while the scene was empty",
      .comparison =
          Verdict::Comparison{.value = {}, .limit = static_cast<double>(kDetectionFrames)}};
  if (slowest == detections.end()) return verdict;
  verdict.comparison->value = static_cast<double>(slowest->frames);
  verdict.state = isLate(*slowest) ? Verdict::State::kFailed : Verdict::State::kPassed;
  verdict.found = slowest->isFound
                      ? fmt::format("{} frames, {:.0f} ms", slowest->frames,
                                    1000 * hal::toSeconds(slowest->time))
                      : fmt::format("the one that came in frame {} was never", slowest->frame);
  return verdict;
}

}  // namespace

std::vector<Verdict> moverVerdicts(const MoverReport& movers, MoverMarks marks) {
  const MoverSummary& painting = movers.painting;
  std::vector<Verdict> verdicts{verdictOf(kStillLimit, painting.stillPercent),
                                verdictOf(kReturnLimit, painting.returnLevels),
                                verdictOf(kGhostLimit, painting.ghost)};
  // Few sequences have a lamp that is switched.
  if (painting.follow) verdicts.push_back(verdictOf(kFollowLimit, painting.follow));
  // Most sequences begin without a mover.
  if (painting.remainsPercent && !marks.areOnPaper) {
    verdicts.push_back(verdictOf(kRemainsLimit, painting.remainsPercent));
  }
  for (Verdict& verdict : verdictsAlong(movers.alongMotion[Subject::kPainting],
                                        movers.alongMotion[Subject::kInput], marks.areLines)) {
    verdicts.push_back(std::move(verdict));
  }
  if (!marks.areOnPaper) verdicts.push_back(verdictOf(kLostLimit, painting.lostPercent));
  return verdicts;
}

std::vector<Verdict> moverControlVerdicts(const MoverReport& movers, MoverMarks marks) {
  std::vector<Verdict> verdicts{verdictOf(kAveragingLost, movers.averaging.lostPercent),
                                redrawnVerdict(movers.alongMotion[Subject::kFresh],
                                               movers.alongMotion[Subject::kInput], marks.areLines),
                                verdictOf(kDisplacedStill, movers.displacedStillPercent)};
  if (movers.averaging.follow) {
    verdicts.push_back(verdictOf(kAveragingFollow, movers.averaging.follow));
  }
  return verdicts;
}

std::vector<Verdict> labelVerdicts(const std::optional<LabelSummary>& labels,
                                   std::optional<double> stillFlipsPercent) {
  std::vector<Verdict> verdicts;
  if (labels && labels->hasMovers) verdicts.push_back(detectionVerdict(labels->detections));
  if (labels && !labels->hasMovers) {
    verdicts.push_back(verdictOf(kFlipsLimit, labels->flipsPercent));
  }
  verdicts.push_back(verdictOf(kStillFlipsLimit, stillFlipsPercent));
  return verdicts;
}

std::vector<Verdict> labelControlVerdicts(const LabelSummary& labels) {
  if (!labels.hasMovers) return {};
  return {verdictOf(kDisplacedIouLimit, labels.displacedIou)};
}

}  // namespace pleinair::measure
