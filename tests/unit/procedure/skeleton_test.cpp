#include "pipeline/procedure/skeleton.h"

#include <array>
#include <cstdint>

#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::procedure {
namespace {

using testing::HasSubstr;

/// The folder of a skeleton in memory, with the model that it was made for.
class SkeletonSources : public MemorySources {
 public:
  SkeletonSources(std::shared_ptr<const scene::Model> model, const Skeleton& skeleton)
      : model_(std::move(model)) {
    for (const auto& [language, text] : skeleton.texts) texts[language + ".md"] = text;
  }
  hal::Result<std::shared_ptr<const scene::Model>> model(const scene::ModelSource&) override {
    return model_;
  }

 private:
  std::shared_ptr<const scene::Model> model_;
};

const std::vector<std::string> kLanguages{"en", "pt-BR"};

TEST(Skeleton, IsASoundProcedureWithAStepForEachNodeOrSeries) {
  const auto model = modelWithParts(
      {"Cover", "bolt_1", "bolt_2", "bolt_3", "end", "éé", "bolt_plate", "M8.001", "M8.002"});
  const Skeleton skeleton = skeletonOf(*model, "my \"machine\"", "builtin:gearbox", "", kLanguages);
  SkeletonSources sources(model, skeleton);
  const ProcedureReading reading = readProcedure(skeleton.toml, "p.toml", sources);
  EXPECT_EQ(messagesOf(reading), "") << skeleton.toml;
  std::vector<std::string> ids;
  for (const Step& step : reading.procedure.steps) ids.push_back(step.id);
  EXPECT_THAT(ids, testing::ElementsAre("cover", "bolt", "part", "part_2", "bolt_plate", "m8"));
  EXPECT_THAT(reading.procedure.steps[1].parts, testing::ElementsAre(1, 2, 3))
      << "not the plate, whose name begins in the same way";
  EXPECT_EQ(skeleton.steps, 6U);
}

TEST(Skeleton, NumberedNodesOfDifferentShapesHaveStepsOfTheirOwn) {
  auto model = *modelWithParts({"body", "body_1", "body_2", "body_3", "body_4", "body_4"});
  const std::array<std::uint32_t, 6> triangles{12, 300, 12, 40, 40, 7};
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    model.parts[i].triangleCount = triangles.at(i);
  }
  const Skeleton skeleton = skeletonOf(model, "m", "builtin:gearbox", "", kLanguages);
  EXPECT_EQ(skeleton.steps, 3U) << skeleton.toml;
  EXPECT_THAT(skeleton.toml, HasSubstr("id = \"body\"\nparts = [\"body\", \"body_2\"]"));
  EXPECT_THAT(skeleton.toml, HasSubstr("id = \"body_1\"\nparts = [\"body_1\"]"));
  EXPECT_THAT(skeleton.toml, HasSubstr("id = \"body_3\"\nparts = [\"body_3\", \"body_4\"]"));
}

TEST(Skeleton, OfTheGearbox) {
  const auto model = std::make_shared<const scene::Model>(scene::gearboxModel({.isClosed = true}));
  const Skeleton skeleton = skeletonOf(*model, "gearbox", "builtin:gearbox", "", kLanguages);
  SkeletonSources sources(model, skeleton);
  EXPECT_EQ(messagesOf(readProcedure(skeleton.toml, "p.toml", sources)), "");
  EXPECT_THAT(skeleton.toml, HasSubstr("id = \"cover_bolt\"\nparts = [\"cover_bolt_*\"]"));
  EXPECT_THAT(skeleton.texts.at("en"), HasSubstr("## oil_plug: oil plug\n"));
}

TEST(Skeleton, NodesBeyondTheLargestNumberOfStepsAreNamed) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kMaxSteps + 3; ++i) names.push_back("a" + std::to_string(i) + "b");
  const Skeleton skeleton =
      skeletonOf(*modelWithParts(names), "m", "builtin:gearbox", "", kLanguages);
  EXPECT_EQ(skeleton.steps, kMaxSteps);
  EXPECT_EQ(skeleton.leftOut.size(), 3U);
}

}  // namespace
}  // namespace pleinair::procedure
