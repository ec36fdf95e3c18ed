#include "pipeline/overlay/tag_contradictions.h"

#include <memory>
#include <optional>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace pleinair::overlay {
namespace {

/// Three tags in a row, and a machine on the first.
class TagContradictionsTest : public testing::Test {
 protected:
  TagContradictionsTest() {
    for (int id = 0; id < 3; ++id) {
      scene_.tags.push_back({.id = id, .edgeMetres = 0.05, .worldFromTag = at(0.2 * id)});
    }
    scene_.models.push_back({.name = "machine", .tagId = 0});
    contradictions_.emplace(scene_, 0);
  }
  static glm::dmat4 at(double x) {
    return glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0.0, 0.0));
  }
  /// A frame that shows these tags; of `strange` ones, which do not fit, their own places.
  /// Those of `carried` do not fit either, and are not seen any more.
  bool see(const std::vector<int>& fitting, const std::vector<int>& strange = {},
           const std::vector<int>& carried = {}) {
    std::vector<tracking::TrackedTag> tags;
    const glm::dmat4 cameraFromWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.2, 1.0));
    for (const int id : fitting)
      tags.push_back({.id = id, .cameraFromTag = cameraFromWorld * at(0.2 * id)});
    for (const int id : strange)
      tags.push_back({.id = id, .cameraFromTag = cameraFromWorld * at(0.2 * id + 0.02)});
    for (const int id : carried) {
      tags.push_back({.id = id,
                      .cameraFromTag = cameraFromWorld * at(0.2 * id + 0.02),
                      .source = tracking::PoseSource::kCarried});
    }
    tracking::TrackingResult tracked;
    tracked.tags = tags;
    if (!fitting.empty()) tracked.cameraFromWorld = cameraFromWorld;
    return contradictions_->update(tracked);
  }

  scene::Scene scene_;
  std::optional<TagContradictions> contradictions_;
};

TEST_F(TagContradictionsTest, TagsThatFitAreBelievedOneByOneToo) {
  EXPECT_FALSE(see({0}));
  EXPECT_FALSE(see({0, 1, 2}));
  EXPECT_FALSE(see({1}));
}

TEST_F(TagContradictionsTest, OfTwoNeitherIsBelievedNorAloneLater) {
  EXPECT_TRUE(see({0}, {1}));
  EXPECT_TRUE(see({0}));
  EXPECT_TRUE(see({1}));
  EXPECT_TRUE(see({})) << "carried: as before";
  EXPECT_FALSE(see({2})) << "that one has contradicted nobody";
}

TEST_F(TagContradictionsTest, OfThreeThoseThatAgreeAre) {
  EXPECT_FALSE(see({0, 2}, {1}));
  EXPECT_FALSE(see({0}));
  EXPECT_TRUE(see({1})) << "it did not fit, and places the machine alone";
  EXPECT_FALSE(see({0, 1})) << "it was put right";
  EXPECT_FALSE(see({1}));
}

TEST_F(TagContradictionsTest, TheMachinesOwnTagPlacesItWhateverOthersAgreeOn) {
  EXPECT_TRUE(see({1, 2}, {0}));
  EXPECT_TRUE(see({1, 2}, {}, {0})) << "a hand has covered it, and its pose is carried";
  EXPECT_FALSE(see({1, 2})) << "by the others";
}

TEST_F(TagContradictionsTest, AreRememberedByTheNextPainter) {
  const auto kept = std::make_shared<DoubtfulTags>();
  contradictions_.emplace(scene_, 0, kept);
  EXPECT_TRUE(see({0}, {1}));
  contradictions_.emplace(scene_, 0);
  EXPECT_FALSE(see({1})) << "it knows nothing of what was before";
  contradictions_.emplace(scene_, 0, kept);
  EXPECT_TRUE(see({1}));
  EXPECT_FALSE(see({1, 2})) << "it was put right";
  contradictions_.emplace(scene_, 0, kept);
  EXPECT_FALSE(see({1}));
  EXPECT_TRUE(see({0}));
}

TEST_F(TagContradictionsTest, OfAnotherSceneNothingIsRemembered) {
  const auto kept = std::make_shared<DoubtfulTags>();
  contradictions_.emplace(scene_, 0, kept);
  EXPECT_TRUE(see({0}, {1}));
  scene_.tags.push_back({.id = 3, .edgeMetres = 0.05, .worldFromTag = at(0.6)});
  contradictions_.emplace(scene_, 0, kept);
  EXPECT_FALSE(see({0}));
}

TEST_F(TagContradictionsTest, AMachineWhoseTagHasNoPlaceIsPlacedByThatAlone) {
  scene_.tags[0].worldFromTag.reset();
  contradictions_.emplace(scene_, 0);
  EXPECT_FALSE(see({1}, {2}));
  EXPECT_FALSE(see({1}));
}

}  // namespace
}  // namespace pleinair::overlay
