// How movers go, from how they lie on their last picture: dense flow, which beside an outline holds
// the background too, says too little.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gmock/gmock.h>

#include "tests/gpu/marks/motion_layers_fixture.h"

namespace pleinair::marks {
namespace {

/// A plain body before a wall and a limb that hangs from it, of one colour.
class MoverRegistration : public MotionLayersTest {
 protected:
  struct Pose {
    double body = 0.0;  ///< px from the left
    double limb = 0.0;
  };
  static constexpr double kBodyTop = 40.0;
  static constexpr double kLimbTop = 130.0;
  static constexpr double kLimbBottom = 215.0;
  static constexpr double kHalfBody = 38.0;
  static constexpr double kHalfLimb = 13.0;

  static bool isBody(const Pose& pose, glm::dvec2 px, double more = 0.0) {
    return px.y > kBodyTop - more && px.y < kLimbTop + more &&
           std::abs(px.x - pose.body) < kHalfBody + more;
  }
  static bool isLimb(const Pose& pose, glm::dvec2 px, double more = 0.0) {
    return px.y >= kLimbTop && px.y < kLimbBottom + more &&
           std::abs(px.x - pose.limb) < kHalfLimb + more;
  }

  /// Dense flow that says `said` where a mover was or is, and nothing elsewhere; until the next
  /// call.
  template <class IsThere>
  tracking::ImageMotion flowOf(IsThere wasThere, IsThere isThere, glm::vec2 said) {
    constexpr hal::FrameSize kNodes{40, 30};
    constexpr double kNodePx = 8.0;
    constexpr float kErrorPx = 0.1F;
    forward_.clear();
    backward_.clear();
    for (int y = 0; y < kNodes.height; ++y) {
      for (int x = 0; x < kNodes.width; ++x) {
        const glm::dvec2 px = kNodePx * (glm::dvec2(x, y) + 0.5);
        forward_.emplace_back(wasThere(px) ? said : glm::vec2(0.0F), kErrorPx, 0.0F);
        backward_.emplace_back(isThere(px) ? -said : glm::vec2(0.0F), kErrorPx, 0.0F);
      }
    }
    tracking::ImageMotion motion = panning(0.0, 0.0);
    motion.picture->errorPx = 1.0;
    motion.flow = {
        .nodes = kNodes, .stepPx = glm::vec2(kNodePx), .forward = forward_, .backward = backward_};
    return motion;
  }

  /// The mover goes from the last pose to this one. Of that of the body, flow says the given share,
  /// on the limb as on the body.
  void seePose(const Pose& pose, double share) {
    constexpr double kBleeding = 8.0;
    const Pose last = last_.value_or(pose);
    const auto reaches = [](const Pose& there) {
      return [there](glm::dvec2 px) {
        return isBody(there, px, kBleeding) || isLimb(there, px, kBleeding);
      };
    };
    const glm::vec2 said(share * (pose.body - last.body), 0.0);
    hal::Image image = seen({}, kSize, ++noise_);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const glm::dvec2 px(x, y);
        if (!isBody(pose, px) && !isLimb(pose, px)) continue;
        std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        p[0] = 235;
        p[1] = 60;
        p[2] = 30;
      }
    }
    seeImage(image, flowOf(reaches(last), reaches(pose), said));
    last_ = pose;
  }

  /// A body as high as the picture, of a soft, faint pattern, has come to `middle` from `last`.
  /// Flow knows how it goes sideways; nothing but its pattern shows how it rises and falls.
  void seeSoftBody(glm::dvec2 middle, glm::dvec2 last) {
    constexpr double kBleeding = 8.0;
    constexpr double kAmplitude = 3.0;  // levels
    constexpr double kWaves = 2.0 * 3.14159265 / 40.0;
    const auto reaches = [](double x) {
      return [x](glm::dvec2 px) { return std::abs(px.x - x) < kHalfBody + kBleeding; };
    };
    hal::Image image = seen({}, kSize, ++noise_);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const glm::dvec2 at = glm::dvec2(x, y) - middle;
        if (std::abs(at.x) >= kHalfBody) continue;
        const double tone = kAmplitude * (std::sin(kWaves * at.x) + std::sin(kWaves * at.y));
        std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        p[0] = static_cast<std::uint8_t>(std::lround(200.0 + tone));
        p[1] = static_cast<std::uint8_t>(std::lround(60.0 + tone));
        p[2] = static_cast<std::uint8_t>(std::lround(40.0 + tone));
      }
    }
    seeImage(image, flowOf(reaches(last.x), reaches(middle.x), {middle.x - last.x, 0.0}));
  }

  /// The displacement of the mover that is nearest to a place.
  glm::vec2 motionAt(glm::dvec2 px) const {
    const std::vector<glm::vec4> texels = texelsOf(layers_->moverMotion());
    const hal::FrameSize size = layers_->moverMotion().size();
    const int rows = size.height / MotionLayers::kMostMovers;
    const glm::ivec2 block(
        px / static_cast<double>(MotionLayers::kCellPixels * MotionLayers::kBlockCells));
    glm::vec4 best(0.0F);
    for (int i = 0; i < MotionLayers::kMostMovers; ++i) {
      const auto at = static_cast<std::size_t>((i * rows + block.y) * size.width + block.x);
      if (texels.at(at).z > best.z) best = texels.at(at);
    }
    return best.z > 0.0F ? glm::vec2(best) / best.z : glm::vec2(0.0F);
  }

 private:
  std::vector<glm::vec4> forward_;
  std::vector<glm::vec4> backward_;
  std::optional<Pose> last_;
  unsigned noise_ = 0;
};

/// Flow says 60 % of its motion, as it does beside outlines.
TEST_F(MoverRegistration, APlainMoverIsFollowedThoughFlowFallsShort) {
  constexpr double kSpeed = 6.0;
  constexpr double kSaid = 0.6;
  constexpr int kFirst = 8;
  constexpr int kLast = 21;
  for (int i = 0; i < 6; ++i) see({});
  double body = 0.0;
  double limb = 0.0;
  double anchors = 0.0;
  int count = 0;
  for (int i = 0; i <= kLast; ++i) {
    const Pose pose{60.0 + kSpeed * i, 60.0 + kSpeed * i};
    seePose(pose, kSaid);
    if (i < kFirst) continue;
    body += motionAt({pose.body, 80.0}).x;
    limb += motionAt({pose.limb, 170.0}).x;
    for (const Anchor& anchor : set_->read()) {
      if (!anchor.isStaying() || anchor.isBorn() || (anchor.state & Anchor::kMover) == 0) continue;
      anchors += anchor.displacementPx.x;
      ++count;
    }
  }
  // It shows nothing but its outline: of what flow misses, eight tenths are left at most.
  const double least = kSpeed - 0.8 * (1.0 - kSaid) * kSpeed;
  constexpr int kFrames = kLast - kFirst + 1;
  EXPECT_GT(body / kFrames, least);
  EXPECT_GT(limb / kFrames, least);
  EXPECT_LT(std::max(body, limb) / kFrames, kSpeed + 0.2);
  EXPECT_GT(count, 20 * kFrames);
  EXPECT_GT(anchors / count, least);
}

TEST_F(MoverRegistration, ALimbGoesByItself) {
  constexpr double kSpeed = 3.0;
  constexpr double kSwing = 16.0;
  const auto poseOf = [](int frame) {
    const double body = 80.0 + kSpeed * frame;
    return Pose{body, body + kSwing * std::sin(0.45 * frame)};
  };
  for (int i = 0; i < 6; ++i) see({});
  double worstBody = 0.0;
  double off = 0.0;  // of the limb's own motion
  double swing = 0.0;
  for (int i = 0; i < 36; ++i) {
    const Pose pose = poseOf(i);
    seePose(pose, 1.0);
    if (i < 8) continue;
    const double truth = pose.limb - poseOf(i - 1).limb;
    off += std::abs(motionAt({pose.limb, 180.0}).x - truth);
    swing += std::abs(truth - kSpeed);
    worstBody = std::max(worstBody, std::abs(motionAt({pose.body, 72.0}).x - kSpeed));
  }
  EXPECT_LT(off, 0.35 * swing) << "as far off as the body's motion: 1";
  EXPECT_LT(worstBody, 1.0);
}

/// A walker's clothes show how the trunk rises and falls with each step, faint as they are.
TEST_F(MoverRegistration, AFaintPatternIsFollowed) {
  constexpr int kFirst = 8;
  constexpr int kLast = 36;
  const auto placeOf = [](int frame) {
    return glm::dvec2(70.0 + 4.0 * frame, 100.0 + 5.0 * std::sin(0.45 * frame));
  };
  for (int i = 0; i < 6; ++i) see({});
  double off = 0.0;
  double rise = 0.0;
  for (int i = 0; i <= kLast; ++i) {
    const glm::dvec2 last = placeOf(std::max(i - 1, 0));
    seeSoftBody(placeOf(i), last);
    if (i < kFirst) continue;
    const double truth = placeOf(i).y - last.y;
    off += std::abs(motionAt({placeOf(i).x, 120.0}).y - truth);
    rise += std::abs(truth);
  }
  EXPECT_LT(off, 0.31 * rise) << "if it only went sideways: 1";
}

}  // namespace
}  // namespace pleinair::marks
