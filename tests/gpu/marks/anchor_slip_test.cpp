// Anchors against the exact place of what they lie on, over two seconds of motions in closed form,
// told by one source at a time.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/marks_fixture.h"

namespace pleinair::marks {
namespace {

using tracking::FeatureMotion;
using tracking::ImageMotion;

constexpr int kFrames = 60;
constexpr double kMaxDriftPx = 0.05;

glm::dmat3 translation(double x, double y) {
  return {1, 0, 0, 0, 1, 0, x, y, 1};
}
/// About the picture's middle.
glm::dmat3 about(const glm::dmat3& h) {
  return translation(160.0, 120.0) * h * translation(-160.0, -120.0);
}
glm::dmat3 rotation(double angle) {
  return about(
      {std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0, 0, 0, 1});
}
glm::dmat3 zoom(double factor) {
  return about({factor, 0, 0, 0, factor, 0, 0, 0, 1});
}

/// Where each anchor was first seen, and how far it has come from where that should be now.
class Slips {
 public:
  /// `exact`: what takes a place of the frame before to this one.
  void add(const std::vector<Anchor>& anchors, const std::function<glm::dvec2(glm::dvec2)>& exact) {
    followed_.resize(anchors.size());
    for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
      const Anchor& each = anchors[slot];
      std::optional<Followed>& followed = followed_[slot];
      if (!each.isAlive()) {
        followed.reset();
      } else if (!followed || followed->seed != each.seed) {
        followed = Followed{.seed = each.seed, .expected = glm::dvec2(each.px)};
      } else {
        followed->expected = exact(followed->expected);
        ++followed->frames;
        const double slip = glm::distance(glm::dvec2(each.px), followed->expected);
        worst_ = std::max(worst_, slip);
        squares_ += slip * slip;
        ++count_;
        longest_ = std::max(longest_, followed->frames);
      }
    }
  }
  double worst() const { return worst_; }
  double rms() const { return std::sqrt(squares_ / count_); }
  int longest() const { return longest_; }

 private:
  struct Followed {
    std::uint32_t seed = 0;
    glm::dvec2 expected{0.0};
    int frames = 0;
  };
  std::vector<std::optional<Followed>> followed_;
  double worst_ = 0.0;
  double squares_ = 0.0;
  int count_ = 0;
  int longest_ = 0;
};

/// An exact motion that only one source reports.
struct Telling {
  std::vector<FeatureMotion> features;
  std::vector<glm::vec4> forward;
  std::vector<glm::vec4> backward;
  ImageMotion motion;
};

constexpr int kNodePixels = 8;

Telling tell(MotionSource source, const glm::dmat3& currentFromPrevious, hal::FrameSize size) {
  Telling told;
  const glm::dmat3 previousFromCurrent = glm::inverse(currentFromPrevious);
  if (source == MotionSource::kPicture) {
    told.motion.picture = {.currentFromPrevious = currentFromPrevious, .errorPx = 0.01};
  } else if (source == MotionSource::kFeatures) {
    // As many as a tracker has, beyond the borders as well, so that each place has a triangle.
    for (int y = -1; y < 12; ++y) {
      for (int x = -1; x < 17; ++x) {
        const glm::dvec2 then(x * 20 + 5 + 7 * ((x + y) % 2), y * 20 + 6 + 5 * (x % 3));
        told.features.push_back({.id = static_cast<std::uint32_t>(told.features.size()),
                                 .previous = glm::vec2(then),
                                 .current = glm::vec2(moved(currentFromPrevious, then)),
                                 .errorPx = 0.01F});
      }
    }
    told.motion.features = told.features;
  } else {
    const hal::FrameSize nodes{size.width / kNodePixels, size.height / kNodePixels};
    for (int y = 0; y < nodes.height; ++y) {
      for (int x = 0; x < nodes.width; ++x) {
        const glm::dvec2 here = glm::dvec2(x + 0.5, y + 0.5) * double{kNodePixels};
        told.forward.emplace_back(glm::vec2(moved(currentFromPrevious, here) - here), 0.01F, 0.0F);
        told.backward.emplace_back(glm::vec2(here - moved(previousFromCurrent, here)), 0.01F, 0.0F);
      }
    }
    told.motion.flow = {.nodes = nodes,
                        .stepPx = glm::vec2(kNodePixels),
                        .forward = told.forward,
                        .backward = told.backward};
  }
  return told;
}

struct Case {
  std::string name;
  MotionSource source;
  glm::dmat3 step;
};

std::ptrdiff_t movedByOthers(const std::vector<Anchor>& anchors, MotionSource source) {
  return std::ranges::count_if(anchors, [&](const Anchor& each) {
    return each.isAlive() && !each.isBorn() && each.source() != source;
  });
}

class AnchorDrift : public MarksTest, public testing::WithParamInterface<Case> {};

TEST_P(AnchorDrift, StaysBelowATwentiethOfAPixel) {
  scene::ArFrameRenderer renderer(library_, {});
  MotionField field(library_, kSize);
  AnchorSet set(library_, kSize, {});
  const Telling told = tell(GetParam().source, GetParam().step, kSize);
  Slips slips;
  for (int i = 0; i < kFrames + 1; ++i) {
    const scene::ArFrame frame = compose(renderer, {}, i == 0 ? ImageMotion{} : told.motion);
    field.update(frame);
    set.advance(frame, field);
    const std::vector<Anchor> anchors = set.read();
    slips.add(anchors, [](glm::dvec2 px) { return moved(GetParam().step, px); });
    ASSERT_EQ(movedByOthers(anchors, GetParam().source), 0);
  }
  RecordProperty("worst_px", std::to_string(slips.worst()));
  RecordProperty("rms_px", std::to_string(slips.rms()));
  EXPECT_EQ(slips.longest(), kFrames);
  EXPECT_LT(slips.worst(), kMaxDriftPx);
}

std::vector<Case> cases() {
  const std::vector<std::pair<std::string, MotionSource>> sources{
      {"Picture", MotionSource::kPicture},
      {"Features", MotionSource::kFeatures},
      {"Flow", MotionSource::kFlow}};
  std::vector<Case> all;
  for (const auto& [name, source] : sources) {
    all.push_back({"TranslationBy" + name, source, translation(-0.7, 0.4)});
    all.push_back({"RotationBy" + name, source, rotation(0.004)});
    all.push_back({"ZoomInBy" + name, source, zoom(1.004)});
    all.push_back({"ZoomOutBy" + name, source, zoom(0.996)});
  }
  all.push_back({"HomographyByPicture", MotionSource::kPicture,
                 about({1.002, 0.003, 4e-6, -0.002, 1.001, -6e-6, 0.3, -0.2, 1.0})});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Motions, AnchorDrift, testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

/// A camera that goes around over a desk whose pose is known.
TEST_F(MarksTest, AnchorsOnAPlaneStayWithItsTruePose) {
  scene::Scene scene;
  scene.planes.push_back({.name = "desk", .sizeMetres = {2.0, 2.0}});
  scene::ArFrameRenderer renderer(library_, scene);
  MotionField field(library_, kSize);
  AnchorSet set(library_, kSize, {});
  const auto poseAt = [](int i) {
    const double t = 0.01 * i;
    return glm::rotate(glm::translate(glm::dmat4(1.0), {0.01 - 0.05 * t, 0.06 * t, 0.5 - 0.1 * t}),
                       0.8 + 0.2 * t, {1.0, 0.2 + 0.1 * t, 0.3 * t});
  };
  const auto onPlane = [](const glm::dmat4& pose, glm::dvec2 px) {
    const glm::dvec3 ray((px.x - 162.0) / 300.0, (px.y - 118.0) / 302.0, 1.0);
    const glm::dvec3 normal(pose[2]);
    const double depth = glm::dot(glm::dvec3(pose[3]), normal) / glm::dot(ray, normal);
    return glm::inverse(pose) * glm::dvec4(depth * ray, 1.0);
  };
  Slips slips;
  for (int i = 0; i < kFrames + 1; ++i) {
    const scene::ArFrame frame = compose(renderer, {.cameraFromWorld = poseAt(i)}, {});
    field.update(frame);
    set.advance(frame, field);
    const std::vector<Anchor> anchors = set.read();
    slips.add(anchors, [&](glm::dvec2 px) {
      return camera().project(glm::dvec3(poseAt(i) * onPlane(poseAt(i - 1), px)));
    });
    ASSERT_EQ(movedByOthers(anchors, MotionSource::kPlane), 0);
  }
  RecordProperty("worst_px", std::to_string(slips.worst()));
  RecordProperty("rms_px", std::to_string(slips.rms()));
  EXPECT_GT(slips.longest(), kFrames / 2);
  EXPECT_LT(slips.worst(), kMaxDriftPx);
}

}  // namespace
}  // namespace pleinair::marks
