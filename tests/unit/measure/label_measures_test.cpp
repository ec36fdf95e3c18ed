// Labels of movers that are made so that their overlap, delay and flips are known.
#include "pipeline/measure/label_measures.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include <gmock/gmock.h>

#include "pipeline/measure/mover_gates.h"

namespace pleinair::measure {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 180;
constexpr int kComes = 10;
constexpr int kFrames = 60;
constexpr int kStep = 6;

hal::TimePoint timeOf(int frame, int framesPerSecond = 30) {
  return hal::TimePoint(std::chrono::microseconds(1000000LL * frame / framesPerSecond));
}

/// A bar of 40 px comes from the left and leaves to the right.
cv::Mat1b truthOf(int frame) {
  cv::Mat1b mask(kHeight, kWidth, static_cast<unsigned char>(0));
  const cv::Rect bar =
      cv::Rect((frame - kComes) * kStep - 40, 40, 40, 80) & cv::Rect(0, 0, kWidth, kHeight);
  if (!bar.empty()) mask(bar).setTo(255);
  return mask;
}

cv::Mat1b noLabels() {
  cv::Mat1b labels(kHeight / 2, kWidth / 2);
  labels.setTo(0);
  return labels;
}

/// A right label for every cell.
cv::Mat1b labelsOf(int frame) {
  cv::Mat1b labels(kHeight / 2, kWidth / 2);
  const cv::Mat1b truth = truthOf(frame);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) labels(y, x) = truth(2 * y, 2 * x);
  }
  return labels;
}

LabelSummary summaryOf(const std::function<cv::Mat1b(int)>& label, int framesPerSecond = 30) {
  LabelMeasures measures;
  for (int i = 0; i < kFrames; ++i) {
    measures.add(static_cast<std::uint64_t>(i), timeOf(i, framesPerSecond), label(i), truthOf(i));
  }
  return measures.total();
}

std::vector<Verdict> verdictsOf(const LabelSummary& labels) {
  return labelVerdicts(labels, 0.0);
}

TEST(LabelMeasures, TrueLabelsPass) {
  const LabelSummary labels = summaryOf(labelsOf);
  EXPECT_DOUBLE_EQ(labels.meanIou.value(), 1.0);
  EXPECT_DOUBLE_EQ(labels.worstIou.value(), 1.0);
  EXPECT_DOUBLE_EQ(labels.flipsPercent.value(), 0.0);
  ASSERT_EQ(labels.detections.size(), 1u);
  EXPECT_EQ(labels.detections.front().frames, 0u);
  EXPECT_EQ(verdictsOf(labels).size(), 2u);
  for (const Verdict& verdict : verdictsOf(labels)) {
    EXPECT_EQ(verdict.state, Verdict::State::kPassed) << verdict.what << ": " << verdict.found;
  }
  for (const Verdict& verdict : labelControlVerdicts(labels)) {
    EXPECT_EQ(verdict.state, Verdict::State::kPassed) << verdict.what << ": " << verdict.found;
  }
}

TEST(LabelMeasures, DisplacedLabelsOverlapLess) {
  // The bar of 20 × 40 cells is labelled 5 cells further down: 700 of 900 cells are both.
  const LabelSummary labels = summaryOf([](int frame) {
    cv::Mat1b moved = noLabels();
    const cv::Rect from(0, 0, moved.cols, moved.rows - 5);
    labelsOf(frame)(from).copyTo(moved(from + cv::Point(0, 5)));
    return moved;
  });
  EXPECT_NEAR(labels.meanIou.value(), 700.0 / 900.0, 0.01);
  EXPECT_NEAR(labels.worstIou.value(), 700.0 / 900.0, 0.01);
}

TEST(LabelMeasures, OneBadFrameIsTheWorst) {
  const LabelSummary labels =
      summaryOf([](int frame) { return frame == 30 ? noLabels() : labelsOf(frame); });
  EXPECT_DOUBLE_EQ(labels.worstIou.value(), 0.0);
  EXPECT_EQ(labels.worstFrame, 30u);
  EXPECT_GT(labels.meanIou.value(), 0.95);
}

/// Nothing is labelled until `frames` after the bar is first seen at a noticeable size.
cv::Mat1b lateLabels(int frame, int frames) {
  const int seen = kComes + 1;
  return frame < seen + frames ? noLabels() : labelsOf(frame);
}

TEST(LabelMeasures, ALateLabelFails) {
  const LabelSummary third = summaryOf([](int frame) { return lateLabels(frame, 3); });
  EXPECT_EQ(third.detections.front().frames, 3u);
  EXPECT_EQ(verdictsOf(third).front().state, Verdict::State::kPassed);
  const LabelSummary fourth = summaryOf([](int frame) { return lateLabels(frame, 4); });
  EXPECT_EQ(fourth.detections.front().frames, 4u);
  EXPECT_EQ(verdictsOf(fourth).front().state, Verdict::State::kFailed);
  // Six frames of a fast camera are 100 ms, three of a slow one are 300 ms.
  const auto atRate = [](int frames, int rate) {
    return verdictsOf(summaryOf([&](int frame) { return lateLabels(frame, frames); }, rate))
        .front()
        .state;
  };
  EXPECT_EQ(atRate(6, 60), Verdict::State::kPassed);
  EXPECT_EQ(atRate(7, 60), Verdict::State::kFailed);
  EXPECT_EQ(atRate(3, 10), Verdict::State::kPassed);
}

TEST(LabelMeasures, AMoverThatIsNeverLabelledFails) {
  const LabelSummary labels = summaryOf([](int frame) { return lateLabels(frame, kFrames); });
  EXPECT_FALSE(labels.detections.front().isFound);
  EXPECT_EQ(verdictsOf(labels).front().state, Verdict::State::kFailed);
  EXPECT_THAT(verdictsOf(labels).front().found, testing::HasSubstr("never"));
}

TEST(LabelMeasures, LabelsThatFlipAwayFromMoversAreCounted) {
  const LabelSummary labels = summaryOf([](int frame) {
    cv::Mat1b flickering = labelsOf(frame);
    flickering(cv::Rect(10, 80, 10, 5)).setTo(frame % 2 == 0 ? 255 : 0);
    return flickering;
  });
  // There are 50 of 10800 cells, some of which the bar comes near.
  EXPECT_NEAR(labels.flipsPercent.value(), 0.5, 0.1);
}

TEST(LabelMeasures, NothingMayFlipWhereNothingMoves) {
  const auto verdictWith = [](bool isFlickering) {
    LabelMeasures measures;
    for (int i = 0; i < 5; ++i) {
      cv::Mat1b labels = noLabels();
      if (isFlickering && i == 3) labels(7, 9) = 255;
      measures.add(static_cast<std::uint64_t>(i), timeOf(i), labels, truthOf(0));
    }
    return labelVerdicts(measures.total(), {}).front();
  };
  EXPECT_EQ(verdictWith(false).state, Verdict::State::kPassed);
  EXPECT_EQ(verdictWith(true).state, Verdict::State::kFailed);
  EXPECT_EQ(labelVerdicts({}, 0.01).front().state, Verdict::State::kFailed);
  EXPECT_EQ(labelVerdicts({}, {}).front().state, Verdict::State::kNotMeasured);
}

}  // namespace
}  // namespace pleinair::measure
