// Compares real models in motion with the specification's formulas, and checks invariants at all
// moments.
#include <cmath>
#include <filesystem>
#include <map>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/oracles/gltf_oracle.h"

namespace pleinair::scene {
namespace {

const std::filesystem::path kData = PLEINAIR_SHARED_DATA;

struct MovingModel {
  std::string file;
  std::vector<std::string> clips;
  /// Least number of joints that each clip rotates but does not translate.
  std::size_t turnedBones;
};

class MovingGltf : public testing::TestWithParam<MovingModel> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kData / "models")) GTEST_SKIP() << "no real test data";
    auto read = readGltf(kData / "models" / GetParam().file);
    ASSERT_TRUE(read) << read.error().message();
    model_ = *std::move(read);
  }

  /// Calls `check(moment)` with the pose at `count` moments of each clip, including its ends.
  template <class Check>
  void atMoments(int count, Check check) {
    for (std::size_t clip = 0; clip < model_.rig.clips.size(); ++clip) {
      for (int i = 0; i < count; ++i) {
        const double seconds = model_.rig.clips[clip].seconds * i / (count - 1);
        SCOPED_TRACE(model_.rig.clips[clip].name + " at " + std::to_string(seconds));
        poseModel(model_, ClipMoment{clip, seconds}, hal::Duration::zero(), pose_);
        check(ClipMoment{clip, seconds});
      }
    }
  }

  Model model_;
  ModelPose pose_;
};

TEST_P(MovingGltf, HasItsClips) {
  std::vector<std::string> names;
  for (const Clip& clip : model_.rig.clips) names.push_back(clip.name);
  EXPECT_THAT(names, testing::ElementsAreArray(GetParam().clips));
  EXPECT_THAT(model_.notices, testing::IsEmpty());
}

TEST_P(MovingGltf, StaysWithinItsSphere) {
  double loosest = 0.0;
  atMoments(25, [&](const ClipMoment&) {
    const BoundingSphere sphere = boundingSphere(model_, pose_);
    double farthest = 0.0;
    for (const ModelPart& part : model_.parts) {
      for (std::size_t i = 0; i < part.surfaceCount; ++i) {
        const Mesh& mesh = model_.surfaces[part.firstSurface + i].mesh;
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
          const MeshVertex vertex = posedVertex(model_, part, i, v, pose_);
          ASSERT_NEAR(glm::length(vertex.normal), 1.0F, 1e-5F);
          farthest = std::max(farthest, glm::distance(glm::dvec3(vertex.position), sphere.centre));
        }
      }
    }
    ASSERT_LE(farthest, sphere.radiusMetres * (1.0 + 1e-6));
    loosest = std::max(loosest, sphere.radiusMetres / farthest);
  });
  EXPECT_LT(loosest, 1.5);
}

/// Posed corners of a part's surface, in glTF's axes.
std::vector<glm::dvec3> posedCorners(const Model& model, const ModelPart& part, std::size_t surface,
                                     const ModelPose& pose) {
  std::vector<glm::dvec3> corners;
  for (const auto& triangle : model.surfaces[part.firstSurface + surface].mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const glm::dvec3 p(posedVertex(model, part, surface, vertex, pose).position);
      corners.emplace_back(p.x, p.z, -p.y);
    }
  }
  return corners;
}

/// Whether `found` equals `expected` apart from missing triangles (those without area are dropped).
bool areAmong(const std::vector<glm::dvec3>& found,
              const std::vector<oracles::GltfOracle::Point>& expected, double tolerance) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < expected.size() && next < found.size(); i += 3) {
    bool isSame = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& point = expected[i + c];
      isSame = isSame && glm::distance(found[next + c], {point[0], point[1], point[2]}) < tolerance;
    }
    if (isSame) next += 3;
  }
  return next == found.size();
}

TEST_P(MovingGltf, IsWhereTheSpecificationSays) {
  const oracles::GltfOracle oracle(kData / "models" / GetParam().file);
  const double tolerance = 1e-5 * boundingSphere(model_).radiusMetres;
  ASSERT_EQ(oracle.shownNodes().size(), model_.parts.size());
  for (std::size_t i = 0; i < model_.rig.clips.size(); ++i) {
    EXPECT_EQ(oracle.lastKey(i), model_.rig.clips[i].seconds);
  }
  atMoments(4, [&](const ClipMoment& moment) {
    for (const std::size_t node : oracle.shownNodes()) {
      const ModelPart* part = findPart(model_, oracle.nodeName(node));
      ASSERT_NE(part, nullptr) << oracle.nodeName(node);
      ASSERT_EQ(part->surfaceCount, oracle.primitives(node));
      for (std::size_t i = 0; i < part->surfaceCount; ++i) {
        EXPECT_TRUE(areAmong(posedCorners(model_, *part, i, pose_),
                             oracle.corners(node, i, moment.clip, moment.seconds), tolerance))
            << part->name;
      }
    }
  });
}

TEST_P(MovingGltf, BeginsWithItsFirstKeys) {
  for (std::size_t clip = 0; clip < model_.rig.clips.size(); ++clip) {
    poseModel(model_, ClipMoment{clip, 0.0}, hal::Duration::zero(), pose_);
    for (const Channel& channel : model_.rig.clips[clip].channels) {
      const NodePlace& place = pose_.places[channel.node];
      for (std::size_t i = 0; i < channel.width; ++i) {
        const auto c = static_cast<int>(i);
        const double now = channel.property == AnimatedProperty::kTranslation ? place.translation[c]
                           : channel.property == AnimatedProperty::kScale     ? place.scale[c]
                                                                              : place.rotation[c];
        ASSERT_NEAR(now, static_cast<double>(channel.values[i]), 1e-5);
      }
    }
  }
}

/// Whether a clip translates a joint relative to its parent, according to the file's keys.
bool isShifted(const Clip& clip, std::size_t node) {
  for (const Channel& channel : clip.channels) {
    if (channel.node != node || channel.property != AnimatedProperty::kTranslation) continue;
    for (std::size_t i = 3; i < channel.values.size(); ++i) {
      if (std::abs(channel.values[i] - channel.values[i % 3]) > 1e-6F) return true;
    }
  }
  return false;
}

TEST_P(MovingGltf, KeepsTheLengthsOfBonesThatAreOnlyTurned) {
  std::map<std::pair<std::size_t, std::size_t>, double> lengths;  // by clip and joint
  std::size_t compared = 0;
  const double tolerance = 1e-5 * boundingSphere(model_).radiusMetres;
  atMoments(20, [&](const ClipMoment& moment) {
    for (const Skin& skin : model_.rig.skins) {
      for (const std::size_t joint : skin.joints) {
        const auto parent = model_.rig.nodes[joint].parent;
        if (!parent || isShifted(model_.rig.clips[moment.clip], joint)) continue;
        const double length = glm::distance(glm::dvec3(pose_.rootFromNode[joint][3]),
                                            glm::dvec3(pose_.rootFromNode[*parent][3]));
        const auto known = lengths.try_emplace({moment.clip, joint}, length).first;
        ASSERT_NEAR(length, known->second, tolerance);
        ++compared;
      }
    }
  });
  EXPECT_GE(compared, 20 * model_.rig.clips.size() * GetParam().turnedBones);
}

INSTANTIATE_TEST_SUITE_P(
    All, MovingGltf,
    testing::Values(MovingModel{"BoxAnimated.glb", {"animation 1"}, 0},
                    MovingModel{"Fox.glb", {"Survey", "Walk", "Run"}, 22},
                    MovingModel{"RiggedFigure.glb", {"animation 1"}, 18},
                    MovingModel{"greenman.glb", {"0_pose", "1_idle", "2_move", "3_attack"}, 6},
                    MovingModel{"robot.glb",
                                {"Robot_Dance", "Robot_Death", "Robot_Idle", "Robot_Jump",
                                 "Robot_No", "Robot_Punch", "Robot_Running", "Robot_Sitting",
                                 "Robot_Standing", "Robot_ThumbsUp", "Robot_Walking",
                                 "Robot_WalkJump", "Robot_Wave", "Robot_Yes"},
                                35}),
    [](const auto& instance) {
      return instance.param.file.substr(0, instance.param.file.find('.'));
    });

TEST(StillGltf, HasNoRig) {
  if (!std::filesystem::exists(kData / "models")) GTEST_SKIP() << "no real test data";
  const hal::Result<Model> engine = readGltf(kData / "models/2CylinderEngine.glb");
  ASSERT_TRUE(engine);
  EXPECT_TRUE(engine->rig.nodes.empty());
  ModelPose pose;
  poseModel(*engine, std::nullopt, hal::Duration::zero(), pose);
  ASSERT_EQ(pose.matrices.size(), engine->parts.size());
  for (std::size_t i = 0; i < engine->parts.size(); ++i) {
    EXPECT_EQ(pose.matrices[i], engine->parts[i].modelFromPart);
  }
}

}  // namespace
}  // namespace pleinair::scene
