// Strokes on a skinned model over a whole clip of its animation: what is born on one triangle stays
// one stroke, of one length and one colour.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/description/model_source.h"
#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "tests/gpu/marks/stroke_fixture.h"
#include "tests/gpu/scene/moving_models.h"

namespace pleinair::marks {
namespace {

class StrokesOfAClip : public StrokeTest {
 protected:
  /// A stroke that has been there from the first frame to the last.
  struct Life {
    StrokeSlot first;
    StrokeSlot last;
    std::uint32_t surface = 0;
    std::uint32_t seed = 0;
    float longest = 0.0F;
    float shortest = 1e9F;
    float colourChange = 0.0F;  // the largest since the first frame
  };
  struct Verdict {
    int lives = 0;
    int pairs = 0;             // of strokes that were born on one triangle
    int ended = 0;             // strokes of the first frame that are not there at the end
    double wrongColour = 0.0;  // the share of strokes
    double wrongLength = 0.0;
    double apart = 0.0;  // the share of pairs that are unlike each other though they were alike
  };

  static tracking::CameraModel camera() {
    return {{.fx = 260.0, .fy = 260.0, .cx = 128.0, .cy = 64.0}, {}, kSize};
  }

  /// One round of a clip in so many frames, in light from everywhere. Without `follows` the painter
  /// knows nothing of the model.
  Verdict play(const std::shared_ptr<const scene::Model>& model, std::size_t clip,
               const glm::dmat4& cameraFromModel, int frames, bool follows) {
    scene::Scene scene;
    scene.light.isEstimated = false;
    scene.light.key = glm::vec3(0.0F);
    scene.light.ambient = glm::vec3(1.0F);
    scene.light.shadow = 0.0F;
    scene::SceneModel placed;
    placed.model = model;
    placed.srgb = glm::vec3(1.0F);
    placed.playback.clip = clip;
    scene.models.push_back(placed);
    scene::ArFrameRenderer renderer(library_, scene);
    const gpu::Texture picture =
        support::textureOf(greyPicture(kSize, [](glm::dvec2) { return 0.5; }).view());
    beginAnew({.density = {.cellPixels = 6}});
    motionField_->reset();
    StrokeRule rule;
    rule.segmentPx = 4.0F;
    rule.wanderRad = 0.0F;
    rule.minSteps = 0.0F;
    rule.colourMemory = std::chrono::milliseconds(200);
    const hal::Duration whole = hal::fromSeconds(model->rig.clips[clip].seconds);
    std::map<std::size_t, Life> lives;
    int began = 0;
    for (int i = 0; i <= frames; ++i) {
      scene::ArFrame frame =
          renderer.compose(picture, camera(), {.cameraFromWorld = cameraFromModel}, ++sequence_,
                           hal::TimePoint(i * whole / frames),
                           {.surfaces = true, .shading = scene::Shading::kSmooth});
      motion_ = standing();
      motion_.frameSize = kSize;
      motion_.sinceSequence = sequence_ - 1;
      frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
      const std::vector<std::uint32_t> ids = support::readR32ui(*frame.ids);
      if (!follows) {
        frame.hasObjects = false;
        frame.motion.reset();
        frame.surfaces.reset();
      }
      motionField_->update(frame);
      field_->update(frame, *frame.colour, *motionField_, {});
      anchors_->advance(frame, *motionField_);
      const StrokePaint paints{.background = frame.colour,
                               .models = frame.colour,
                               .movers = frame.colour,
                               .fineModels = frame.colour};
      strokes_->update(frame, *anchors_, *field_, paints, rule);
      const std::vector<StrokeSlot> strokes = readStrokes();
      std::map<std::size_t, Life> still;
      for (const auto& [slot, anchor] : alive()) {
        if (!anchor.isStaying()) continue;
        const StrokeSlot& stroke = strokes[slot];
        const auto known = lives.find(slot);
        if (i > 0 && (known == lives.end() || known->second.seed != anchor.seed)) continue;
        const glm::ivec2 px = glm::clamp(glm::ivec2(anchor.px), glm::ivec2(0),
                                         glm::ivec2(kSize.width - 1, kSize.height - 1));
        const std::uint32_t surface = ids[static_cast<std::size_t>(px.y * kSize.width + px.x)];
        if (i == 0 && surface == 0U) continue;
        Life life =
            i == 0 ? Life{.first = stroke, .surface = surface, .seed = anchor.seed} : known->second;
        life.last = stroke;
        const float length = stroke.lengths.x + stroke.lengths.y;
        life.longest = std::max(life.longest, length);
        life.shortest = std::min(life.shortest, length);
        life.colourChange = std::max(life.colourChange,
                                     glm::distance(hueOf(stroke.colour), hueOf(life.first.colour)));
        still.emplace(slot, life);
      }
      lives = std::move(still);
      if (i == 0) began = static_cast<int>(lives.size());
    }
    return judged(lives, began);
  }

  static Verdict judged(const std::map<std::size_t, Life>& lives, int began) {
    Verdict verdict{.lives = static_cast<int>(lives.size()),
                    .ended = began - static_cast<int>(lives.size())};
    std::map<std::uint32_t, std::vector<const Life*>> byTriangle;
    const auto share = [](int part, int whole) { return whole > 0 ? 1.0 * part / whole : 1.0; };
    int wrongColour = 0;
    int wrongLength = 0;
    for (const auto& [slot, life] : lives) {
      if (life.last.seen < 0.25F) {
        --verdict.lives;
        ++verdict.ended;
        continue;
      }
      byTriangle[life.surface].push_back(&life);
      wrongColour += life.colourChange > kSameColour ? 1 : 0;
      wrongLength += life.longest - life.shortest > kSameLength ? 1 : 0;
    }
    int apart = 0;
    for (const auto& [surface, alike] : byTriangle) {
      for (std::size_t i = 1; i < alike.size(); ++i) {
        const Life& a = *alike[i - 1];
        const Life& b = *alike[i];
        ++verdict.pairs;
        const float before = glm::distance(hueOf(a.first.colour), hueOf(b.first.colour));
        const float after = glm::distance(hueOf(a.last.colour), hueOf(b.last.colour));
        apart += std::abs(after - before) > kSameColour ? 1 : 0;
      }
    }
    verdict.wrongColour = share(wrongColour, verdict.lives);
    verdict.wrongLength = share(wrongLength, verdict.lives);
    verdict.apart = share(apart, verdict.pairs);
    return verdict;
  }

  /// Without its brightness, which the light changes as the surface turns.
  static glm::vec3 hueOf(const glm::vec3& colour) {
    return colour / std::max(colour.r + colour.g + colour.b, 0.1F);
  }
  static constexpr float kSameColour = 0.05F;  // of hueOf()
  static constexpr float kSameLength = 2.0F;   // segments of the eight

  void expectKept(const std::shared_ptr<const scene::Model>& model, std::size_t clip,
                  const glm::dmat4& cameraFromModel, int frames) {
    const Verdict kept = play(model, clip, cameraFromModel, frames, true);
    RecordProperty("lives", kept.lives);
    RecordProperty("pairs", kept.pairs);
    EXPECT_GT(kept.lives, 60);
    EXPECT_GT(kept.pairs, 10);
    RecordProperty("wrong_colour", std::to_string(kept.wrongColour));
    RecordProperty("wrong_length", std::to_string(kept.wrongLength));
    EXPECT_LT(kept.wrongColour, 0.05);
    EXPECT_LT(kept.wrongLength, 0.15);
    EXPECT_LT(kept.apart, 0.1);
    const Verdict bound = play(model, clip, cameraFromModel, frames, false);
    EXPECT_GT(bound.wrongColour, std::max(0.12, 3.0 * kept.wrongColour))
        << "the control: strokes bound to the screen";
  }
};

/// A tube of two colours, which bends.
TEST_F(StrokesOfAClip, AreThoseOfTheirTriangle) {
  scene::Model arm = scene::bendingArm();
  for (scene::MeshVertex& vertex : arm.surfaces[0].mesh.vertices) {
    const bool isRed = std::fmod(std::round((vertex.position.x + 0.12F) / 0.06F), 2.0F) < 0.5F;
    vertex.colour = isRed ? glm::vec4(0.5F, 0.15F, 0.1F, 1.0F) : glm::vec4(0.1F, 0.25F, 0.5F, 1.0F);
  }
  const glm::dmat4 before = glm::translate(glm::dmat4(1.0), {0.05, -0.05, 0.36});
  expectKept(std::make_shared<const scene::Model>(std::move(arm)), 0, before, 30);
}

TEST_F(StrokesOfAClip, OfAWalkingFox) {
  const std::filesystem::path fox = std::filesystem::path(PLEINAIR_SHARED_DATA) / "models/Fox.glb";
  if (!std::filesystem::exists(fox)) GTEST_SKIP() << "without " << fox;
  auto model = scene::readGltf(fox);
  ASSERT_TRUE(model);
  const auto walk = std::ranges::find(model->rig.clips, "Walk", &scene::Clip::name);
  ASSERT_NE(walk, model->rig.clips.end());
  const auto clip = static_cast<std::size_t>(walk - model->rig.clips.begin());
  // 155 units long, seen from its side; y is down in the camera's frame.
  glm::dmat4 before = glm::translate(glm::dmat4(1.0), {0.0, 0.15, 0.65});
  before = glm::rotate(before, 1.5707963, {1.0, 0.0, 0.0});
  before = glm::rotate(before, 1.3, {0.0, 0.0, 1.0});
  before = glm::scale(before, glm::dvec3(0.0035));
  expectKept(std::make_shared<const scene::Model>(*std::move(model)), clip, before, 24);
}

}  // namespace
}  // namespace pleinair::marks
