// The tensor field over time: its memory is carried along the motion, does not lag, and is held
// behind movers.
#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/tensor_field_fixture.h"
#include "tests/oracles/tensor_oracle.h"

namespace pleinair::marks {
namespace {

class TensorMemory : public TensorFieldFixture {};

/// The memory of an image that has gone blank turns with it, and fades.
TEST_F(TensorMemory, MemoryIsCarriedAlongARoll) {
  const auto stripes = [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.6 * px.x); };
  constexpr double kRoll = 0.06;
  constexpr int kFrames = 5;
  const hal::Image blank = greyPicture(kSize, [](glm::dvec2) { return 0.5; });
  for (const double along : {1.0, 0.0}) {
    field_->reset();
    update(greyPicture(kSize, stripes));
    for (int i = 0; i < kFrames; ++i) update(blank, following(rolled(along * kRoll)));
    const std::vector<FieldTexel> regions = read(field_->regions());
    const double theta = along * kFrames * kRoll;  // of the gradient, which was level
    for (const glm::ivec2 at : {glm::ivec2(16, 8), {12, 6}, {19, 10}, {10, 9}}) {
      const FieldTexel& each = regions[placeOf(at.x, at.y)];
      EXPECT_LT(
          degrees(oracles::angleBetween(each.tensor, {std::cos(2 * theta), std::sin(2 * theta)})),
          1.0)
          << along << " at " << at.x << "," << at.y;
      EXPECT_NEAR(each.known, std::exp(-kFrames * 0.033 / 0.4), 0.02);
    }
  }
}

/// Smoothing would lag a roll by ω τ if it were not carried along.
TEST_F(TensorMemory, ARollingPicturesFieldDoesNotLag) {
  constexpr double kRoll = 0.02;
  const auto worstOf = [&](bool isTold) {
    field_->reset();
    double angle = 0.0;
    for (int i = 0; i < 12; ++i) {
      const glm::dvec2 across(std::cos(angle), std::sin(angle));
      update(greyPicture(kSize,
                         [&](glm::dvec2 px) {
                           return 0.5 +
                                  0.3 * std::sin(0.6 * glm::dot(px - glm::dvec2(128, 64), across));
                         }),
             isTold && i > 0 ? following(rolled(kRoll)) : standing());
      angle += kRoll;
    }
    angle -= kRoll;
    const glm::dvec2 truth(std::cos(2 * angle), std::sin(2 * angle));
    double worst = 0.0;
    const std::vector<FieldTexel> resolved = read(field_->resolved(0));
    for (int y = 4; y < 12; ++y) {
      for (int x = 10; x < 22; ++x) {
        const FieldTexel& each = resolved[placeOf(x, y)];
        worst = std::max(worst, degrees(oracles::angleBetween(each.tensor, truth)));
      }
    }
    return worst;
  };
  EXPECT_LT(worstOf(true), 1.5);
  EXPECT_GT(worstOf(false), 4.0) << "the control";
}

TEST_F(TensorMemory, AStillNoisyPicturesFieldDoesNotTremble) {
  const auto trembleOf = [&](const TensorFieldOptions& options) {
    field_->reset();
    std::vector<FieldTexel> before;
    double sum = 0.0;
    int count = 0;
    for (unsigned i = 0; i < 40; ++i) {
      update(greyPicture(kSize, variedLuma, 2.0, i + 1), standing(), options);
      const std::vector<FieldTexel> now = read(field_->resolved(0));
      for (std::size_t at = 0; i > 30 && at < now.size(); ++at) {
        sum += degrees(oracles::angleBetween(now[at].tensor, before[at].tensor));
        ++count;
      }
      before = now;
    }
    return sum / count;
  };
  const double alone = trembleOf(kNoMemory);
  const double steady = trembleOf({});
  RecordProperty("degrees_a_frame", std::to_string(steady) + " of " + std::to_string(alone));
  EXPECT_LT(steady, 0.25);
  EXPECT_LT(steady, 0.25 * alone);
}

/// Told by its detail, a region is of one class or another; noise is not to move it.
TEST_F(TensorMemory, ARegionsClassDoesNotFlicker) {
  // Textures of all strengths, so that many regions are near the border of a class.
  const auto graded = [](glm::dvec2 px) { return 0.5 + 0.0006 * px.x * std::sin(0.9 * px.y); };
  const auto changesOf = [&](double slack) {
    field_->reset();
    std::vector<FieldTexel> before;
    int changes = 0;
    for (unsigned i = 0; i < 60; ++i) {
      update(greyPicture(kSize, graded, 3.0, i + 1), standing(), {.slack = slack});
      const std::vector<FieldTexel> now = read(field_->resolved(0));
      for (std::size_t at = 0; i > 30 && at < now.size(); ++at) {
        for (const double border : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
          changes += (now[at].detail > border) != (before[at].detail > border) ? 1 : 0;
        }
      }
      before = now;
    }
    return changes;
  };
  const int without = changesOf(0.0);
  const int with = changesOf(TensorFieldOptions{}.slack);
  RecordProperty("changes", std::to_string(with) + " of " + std::to_string(without));
  EXPECT_GT(without, 40) << "the control";
  EXPECT_LE(with, without / 20);
}

/// Held detail differs by at most the slack, and is carried along the motion.
TEST_F(TensorMemory, DetailThatIsHeldIsOffByItsSlackAtMost) {
  const TensorFieldOptions options{.memory = hal::Duration(0), .slack = 0.2};
  const auto texture = [](double strength) {
    return [strength](glm::dvec2 px) { return 0.5 + strength * std::sin(0.7 * px.x); };
  };
  const auto detail = [&] { return read(field_->resolved(0))[placeOf(16, 8)].detail; };
  // The strongest edges are the same in all, and so is the threshold.
  const auto withFrame = [&](double strength) {
    return greyPicture(kSize, [=](glm::dvec2 px) {
      return px.y < 16.0 ? (static_cast<int>(px.x) / 4 % 2 == 0 ? 0.9 : 0.1)
                         : texture(strength)(px);
    });
  };
  update(withFrame(0.020), standing(), options);
  const double first = detail();
  update(withFrame(0.022), standing(), options);
  EXPECT_NEAR(detail(), first, 1e-3 * first) << "within the slack it stays";
  update(withFrame(0.040), standing(), options);
  EXPECT_NEAR(detail(), 2.0 * first * 0.8, 0.05 * first) << "beyond, it follows";
  update(withFrame(0.010), standing(), options);
  EXPECT_NEAR(detail(), 0.5 * first / 0.8, 0.05 * first);
}

TEST_F(TensorMemory, TheFieldIsTheSameWhateverTheFrameRate) {
  const hal::Image first = greyPicture(kSize, [](glm::dvec2 px) { return px.x < 128 ? 0.2 : 0.8; });
  const hal::Image then = greyPicture(kSize, [](glm::dvec2 px) { return px.y < 64 ? 0.2 : 0.8; });
  std::vector<std::vector<FieldTexel>> ends;
  for (const int frames : {4, 16}) {
    field_->reset();
    update(first);
    for (int i = 0; i < frames; ++i) {
      update(then, standing(), {}, std::chrono::milliseconds(480) / frames);
    }
    ends.push_back(read(field_->regions()));
  }
  for (std::size_t i = 0; i < ends[0].size(); ++i) {
    EXPECT_NEAR(ends[0][i].known, ends[1][i].known, 0.01) << i;
    EXPECT_LT(glm::distance(ends[0][i].tensor, ends[1][i].tensor), 0.02) << i;
  }
}

TEST_F(TensorMemory, ACutAndAResetForget) {
  const hal::Image other = greyPicture(kSize, [](glm::dvec2 px) { return px.y < 60 ? 0.1 : 0.9; });
  const hal::Image image = greyPicture(kSize, variedLuma);
  const auto bytesOf = [&] { return support::readRgba32f(field_->resolved(0)); };
  update(image);
  const std::vector<float> fresh = bytesOf();
  update(other);
  update(image);
  EXPECT_NE(bytesOf(), fresh) << "the past is to count";
  update(other);
  tracking::ImageMotion cut = standing();
  cut.isCut = true;
  update(image, cut);
  EXPECT_EQ(bytesOf(), fresh);
  update(other);
  field_->reset();
  update(image);
  EXPECT_EQ(bytesOf(), fresh);
}

/// Upright stripes, and a brighter disc with level ones before them.
class TensorsBehindAMover : public TensorMemory {
 protected:
  static constexpr double kRadius = 36.0;

  static double wall(glm::dvec2 px) { return 0.3 + 0.1 * std::sin(0.6 * px.x); }
  static double wallAndDisc(glm::dvec2 px) {
    const bool isDisc = glm::distance(px, glm::dvec2(128.0, 64.0)) < kRadius;
    return isDisc ? 0.8 + 0.15 * std::sin(0.6 * px.y) : wall(px);
  }
  void see(double (*luma)(glm::dvec2), int frames) {
    for (int i = 0; i < frames; ++i) update(greyPicture(kSize, luma, 1.0, ++seed_));
  }
  /// The regions that the disc covers with the width of an edge to spare.
  static std::vector<std::size_t> behindDisc() {
    std::vector<std::size_t> regions;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 32; ++x) {
        const glm::dvec2 middle = 8.0 * (glm::dvec2(x, y) + 0.5);
        if (glm::distance(middle, glm::dvec2(128.0, 64.0)) < kRadius - 12.0) {
          regions.push_back(placeOf(x, y));
        }
      }
    }
    return regions;
  }
  static double angleTo(const FieldTexel& texel, glm::dvec2 tensor) {
    return degrees(oracles::angleBetween(texel.tensor, tensor));
  }

  static constexpr glm::dvec2 kAcross{1.0, 0.0};  // the tensor of upright stripes
  static constexpr glm::dvec2 kDown{-1.0, 0.0};   // of level ones
  unsigned seed_ = 0;
};

TEST_F(TensorsBehindAMover, TheBackgroundsStayAndTheMoverHasItsOwn) {
  layers_.emplace(library_, kSize);
  see(wall, 8);
  const std::vector<FieldTexel> before = read(field_->regions());
  see(wallAndDisc, 12);
  const std::vector<FieldTexel> behind = read(field_->regions());
  const std::vector<FieldTexel> movers = read(field_->movers());
  EXPECT_GT(behindDisc().size(), 20U);
  for (const std::size_t at : behindDisc()) {
    EXPECT_EQ(behind[at].tensor, before[at].tensor) << at;
    EXPECT_EQ(behind[at].known, before[at].known) << at;
    EXPECT_EQ(behind[at].detail, before[at].detail) << at;
    EXPECT_LT(angleTo(behind[at], kAcross), 5.0) << at;
    EXPECT_LT(angleTo(movers[at], kDown), 5.0) << at;
    EXPECT_GT(movers[at].known, 0.5) << at;
  }
  EXPECT_EQ(movers[placeOf(2, 8)].tensor, glm::dvec2(0.0)) << "no mover is near";
  see(wall, 1);
  const std::vector<FieldTexel> after = read(field_->regions());
  for (const std::size_t at : behindDisc()) EXPECT_LT(angleTo(after[at], kAcross), 5.0) << at;
}

/// The control: as many frames of the disc turn the tensors to its own.
TEST_F(TensorsBehindAMover, WithoutLayersTheyTurnToTheMovers) {
  see(wall, 8);
  see(wallAndDisc, 24);
  const std::vector<FieldTexel> behind = read(field_->regions());
  const std::vector<FieldTexel> movers = read(field_->movers());
  for (const std::size_t at : behindDisc()) {
    EXPECT_LT(angleTo(behind[at], kDown), 10.0) << at;
    EXPECT_EQ(movers[at].tensor, glm::dvec2(0.0)) << at;
  }
}

/// The threshold of a strong edge is the background's: the mover has the strongest edges here.
TEST_F(TensorsBehindAMover, EdgesElsewhereAreAsStrongAsBefore) {
  const auto detailBeside = [&] {
    double sum = 0.0;
    const std::vector<FieldTexel> regions = read(field_->regions());
    for (int y = 2; y < 14; ++y) {
      for (int x = 2; x < 7; ++x) sum += regions[placeOf(x, y)].detail / 60.0;
    }
    return sum;
  };
  for (const bool hasLayers : {true, false}) {
    if (hasLayers) {
      layers_.emplace(library_, kSize);
    } else {
      layers_.reset();
    }
    field_->reset();
    see(wall, 8);
    const double before = detailBeside();
    see(wallAndDisc, 12);
    if (hasLayers) {
      EXPECT_NEAR(detailBeside(), before, 0.03 * before);
    } else {
      EXPECT_LT(detailBeside(), 0.85 * before) << "the control";
    }
  }
}

}  // namespace
}  // namespace pleinair::marks
