#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/image/homography.h"
#include "tests/support/random_vectors.h"
#include "tests/support/textured_plane.h"

namespace pleinair::tracking {
namespace {

constexpr hal::FrameSize kSize{640, 480};

/// Pairs that agree with a homography apart from normal errors, and outliers at random positions.
std::vector<PointPair> pairsOf(const glm::dmat3& truth, std::size_t count, double errorPx,
                               double wrongPart) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, errorPx / std::sqrt(2.0));
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 previous =
        support::randomVec2(part, random) * glm::dvec2(kSize.width, kSize.height);
    const bool isWrong = part(random) < wrongPart;
    const glm::dvec2 away = isWrong ? glm::dvec2(90.0 * (part(random) - 0.5), 30.0)
                                    : support::randomVec2(normal, random);
    pairs.push_back(
        {.previous = previous, .current = movedBy(truth, previous) + away, .errorPx = errorPx});
  }
  return pairs;
}

const glm::dmat3 kTruth = support::currentFromPrevious(
    {.turn = 0.03, .zoom = 1.04, .shift = {7.0, -5.0}, .bend = {3e-5, -2e-5}}, kSize);

TEST(HomographyFit, IsExactOfExactPairs) {
  HomographyFitter fitter;
  const auto fit = fitter.fit(pairsOf(kTruth, 40, 1e-4, 0.0), kSize);
  ASSERT_TRUE(fit);
  EXPECT_LT(rmsMotion(glm::inverse(kTruth) * fit->currentFromPrevious, kSize), 1e-3);
  EXPECT_EQ(fit->agreeing, 40U);
}

TEST(HomographyFit, PredictsItsError) {
  HomographyFitter fitter;
  double actual = 0.0;
  double predicted = 0.0;
  for (std::size_t count = 60; count < 120; ++count) {
    const auto fit = fitter.fit(pairsOf(kTruth, count, 0.2, 0.0), kSize);
    ASSERT_TRUE(fit);
    const double off = rmsMotion(glm::inverse(kTruth) * fit->currentFromPrevious, kSize);
    actual += off * off;
    predicted += fit->fitErrorPx * fit->fitErrorPx;
    EXPECT_LT(fit->modelErrorPx, 0.15);
  }
  EXPECT_NEAR(std::sqrt(predicted / actual), 1.0, 0.3);
}

TEST(HomographyFit, IsNotLedAstrayByWrongPairs) {
  HomographyFitter fitter;
  const auto pairs = pairsOf(kTruth, 150, 0.1, 0.35);
  const auto fit = fitter.fit(pairs, kSize);
  ASSERT_TRUE(fit);
  EXPECT_LT(rmsMotion(glm::inverse(kTruth) * fit->currentFromPrevious, kSize), 0.1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double off = glm::distance(movedBy(kTruth, pairs[i].previous), pairs[i].current);
    EXPECT_FALSE(off > 5.0 && fitter.agrees(i)) << i;
    EXPECT_TRUE(off > 0.3 || fitter.agrees(i)) << i;
  }
}

TEST(HomographyFit, SaysByHowMuchThePictureIsNoPlane) {
  HomographyFitter fitter;
  auto pairs = pairsOf(kTruth, 150, 0.02, 0.0);
  std::mt19937 random(2);
  std::normal_distribution<double> depth(0.0, 0.3);
  for (PointPair& pair : pairs) pair.current.x += depth(random);
  const auto fit = fitter.fit(pairs, kSize);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->modelErrorPx, 0.3, 0.08);
}

TEST(HomographyFit, ThereIsNoneOfTooFewOrTooCloseOrWildPairs) {
  HomographyFitter fitter;
  EXPECT_FALSE(fitter.fit({}, kSize));
  EXPECT_FALSE(fitter.fit(pairsOf(kTruth, 8, 0.1, 0.0), kSize));
  EXPECT_FALSE(fitter.fit(pairsOf(kTruth, 200, 0.1, 0.95), kSize));
  auto close = pairsOf(glm::dmat3(1.0), 100, 0.1, 0.0);
  for (PointPair& pair : close) {
    pair.previous /= 6.0;
    pair.current /= 6.0;
  }
  EXPECT_FALSE(fitter.fit(close, kSize)) << "all in a corner";
  const std::vector<PointPair> same(
      50, {.previous = {100.0, 100.0}, .current = {101.0, 100.0}, .errorPx = 0.1});
  EXPECT_FALSE(fitter.fit(same, kSize));
}

}  // namespace
}  // namespace pleinair::tracking
