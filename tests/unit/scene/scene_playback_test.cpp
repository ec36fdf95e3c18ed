// Keys of a [[model]] that control its clips.
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/scene/model_scene.h"

namespace pleinair::scene {
namespace {

class ScenePlayback : public ModelScene {
 protected:
  ScenePlayback() {
    writeClips("still.glb", {});
    writeClips("turner.glb", {"Turn"});
    writeClips("walker.glb", {"Survey", "Walk", "Run"});
  }

  void writeClips(const std::string& file, const std::vector<std::string>& clips) {
    GltfBuilder builder;
    builder.addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int times = builder.addFloats({0, 1}, "SCALAR", 1);
    const int moves = builder.addFloats({0, 0, 0, 1, 0, 0}, "VEC3", 3);
    for (const std::string& clip : clips) {
      builder.root["animations"].push_back(
          {{"name", clip},
           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}},
           {"samplers", {{{"input", times}, {"output", moves}}}}});
    }
    write(file, builder);
  }

  Playback playbackOf(const std::string& source, const std::string& keys) {
    return sceneWith(source, keys).models[0].playback;
  }
};

TEST_F(ScenePlayback, PlaysAnOnlyClip) {
  const Playback playback = playbackOf("turner.glb", "");
  EXPECT_EQ(playback.clip, 0u);
  EXPECT_EQ(playback.speed, 1.0);
  EXPECT_TRUE(playback.loops);
  EXPECT_FALSE(playback.startsOnSight);
  EXPECT_THAT(sceneWith("turner.glb", "").notices, testing::IsEmpty());
}

TEST_F(ScenePlayback, TakesAllKeys) {
  const Playback playback = playbackOf(
      "walker.glb", "clip = \"Walk\"\nspeed = -0.5\nloop = false\nstart = \"on_sight\"\n");
  EXPECT_EQ(playback.clip, 1u);
  EXPECT_EQ(playback.speed, -0.5);
  EXPECT_FALSE(playback.loops);
  EXPECT_TRUE(playback.startsOnSight);
  EXPECT_FALSE(playbackOf("turner.glb", "start = \"at_once\"\n").startsOnSight);
}

TEST_F(ScenePlayback, SaysThatAModelOfManyClipsStandsStill) {
  const Scene scene = sceneWith("walker.glb", "");
  EXPECT_FALSE(scene.models[0].playback.clip);
  EXPECT_THAT(scene.notices,
              testing::ElementsAre("it: stands at rest; clip = \"NAME\" plays one of its "
                                   "animations: Survey, Walk, Run"));
  EXPECT_THAT(sceneWith("walker.glb", "clip = \"Run\"\n").notices, testing::IsEmpty());
  EXPECT_THAT(sceneWith("still.glb", "").notices, testing::IsEmpty());
}

TEST_F(ScenePlayback, SharesAModelThatIsPlayedInTwoWays) {
  const Scene scene = sceneWith("walker.glb",
                                "clip = \"Run\"\n[[model]]\nname = \"other\"\nattach = \"tag:0\"\n"
                                "source = \"walker.glb\"\n");
  ASSERT_EQ(scene.models.size(), 2u);
  EXPECT_EQ(scene.models[0].model, scene.models[1].model);
  EXPECT_EQ(scene.models[0].playback.clip, 2u);
  EXPECT_THAT(scene.notices, testing::ElementsAre(testing::StartsWith("other: stands at rest")));
}

TEST_F(ScenePlayback, ListsTheClipsThatThereAre) {
  EXPECT_EQ(errorOf("walker.glb", "clip = \"Wlak\"\n"),
            "scene.toml:8: model[0].clip: found \"Wlak\" (did you mean \"Walk\"?), allowed: "
            "Survey, Walk, Run");
  EXPECT_EQ(errorOf("walker.glb", "clip = \"Moonwalk\"\n"),
            "scene.toml:8: model[0].clip: found \"Moonwalk\", allowed: Survey, Walk, Run");
  EXPECT_EQ(errorOf("still.glb", "clip = \"Walk\"\n"),
            "scene.toml:8: model[0].clip: found \"Walk\", allowed: a model with animations; this "
            "one has none");
  EXPECT_EQ(errorOf("builtin:gear", "clip = \"Walk\"\n"),
            "scene.toml:8: model[0].clip: found \"Walk\", allowed: a model with animations; this "
            "one has none");
}

TEST_F(ScenePlayback, RefusesKeysThatDoNothing) {
  EXPECT_EQ(
      errorOf("walker.glb", "speed = 2\n"),
      "scene.toml:8: model[0].speed: applies to a clip, but none is played, allowed: clip as one "
      "of Survey, Walk, Run");
  EXPECT_EQ(errorOf("builtin:box", "start = \"on_sight\"\n"),
            "scene.toml:8: model[0].start: applies to a clip, but none is played, allowed: a model "
            "with animations; this one has none");
  EXPECT_EQ(errorOf("turner.glb", "start = \"soon\"\n"),
            "scene.toml:8: model[0].start: found \"soon\", allowed: at_once, on_sight");
  EXPECT_THAT(errorOf("turner.glb", "speed = 1000\n"),
              testing::StartsWith("scene.toml:8: model[0].speed: found 1000"));
}

}  // namespace
}  // namespace pleinair::scene
