// Which of the three programs traces a stroke (shaders/stroke_lists.comp).
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>

#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t kAlive = 0x100;  // shaders/anchor.glsl
constexpr std::uint32_t kMover = 0x2000;
constexpr std::uint32_t kModelSurface = 1U << 22U;  // scene/render/shaders/object_id.glsl
constexpr std::uint32_t kRealSurface = (512U + 1U) << 22U;
constexpr float kSegment = 3.0F;  // px: an arm reaches 4 · 3 + 2
constexpr glm::vec4 kBounds{100.0F, 50.0F, 200.0F, 150.0F};
constexpr std::size_t kHead = 12;  // words before what is listed

/// As in shaders/anchor.glsl.
struct Slot {
  glm::vec2 px{0.0F};
  glm::vec2 displacement{0.0F};
  glm::vec4 jacobian{1.0F, 0.0F, 0.0F, 1.0F};
  std::uint32_t barycentrics = 0, appearance = 0;
  float error = 0.0F, fade = 1.0F;
  std::uint32_t ageAndRank = 0, seed = 0, surface = 0, state = kAlive;
};
static_assert(sizeof(Slot) == 64);

constexpr Slot kFar{.px = {20.0F, 20.0F}};
constexpr Slot kBeside{.px = {100.0F - 13.9F, 90.0F}};
constexpr Slot kBeyond{.px = {100.0F - 14.1F, 90.0F}};
constexpr Slot kOnModel{.px = {150.0F, 90.0F}, .surface = kModelSurface};
constexpr Slot kOnReal{.px = {20.0F, 90.0F}, .surface = kRealSurface};
constexpr Slot kOnMover{.px = {150.0F, 90.0F}, .state = kAlive | kMover};
constexpr Slot kDead{.px = {150.0F, 90.0F}, .state = 0};

struct Lists {
  std::vector<std::uint32_t> onModels, withLabels, moversOnly;
};

class StrokeLists : public support::GlTest {
 protected:
  Lists listsOf(std::vector<Slot> slots, bool hasObjects, bool hasSegments) {
    gpu::ShaderLibrary library;
    library.add(gpu::sceneShaders());
    library.add(gpu::marksShaders());
    gpu::Program program = library.compute("pipeline/marks/strokes/shaders/stroke_lists.comp");
    const auto count = static_cast<std::uint32_t>(slots.size());
    const gpu::Buffer anchors = gpu::Buffer::of(std::span<const Slot>(slots));
    const gpu::Buffer strokes(slots.size() * 96, gpu::BufferUsage::kDynamic);
    std::vector<std::uint32_t> words(kHead + slots.size(), 77U);
    const auto lists =
        gpu::Buffer::of(std::span<const std::uint32_t>(words), gpu::BufferUsage::kDynamic);
    program.use()
        .storage("Anchors", anchors)
        .storage("Strokes", strokes)
        .storage("StrokeLists", lists)
        .set("slots", count)
        .set("segment", kSegment)
        .set("hasObjects", hasObjects ? 1 : 0)
        .set("objectBounds", kBounds)
        .set("pixelsOfFull", glm::vec2(1.0F))
        .set("hasSegments", hasSegments ? 1 : 0)
        .dispatch({1, 1}, GL_BUFFER_UPDATE_BARRIER_BIT);
    words = support::readBuffer<std::uint32_t>(lists);
    for (const std::size_t list : {0U, 4U, 8U}) {
      EXPECT_EQ(words[list], (words[list + 3] + 63U) / 64U) << "groups of list " << list;
    }
    const auto from = [&](std::size_t first, std::size_t length) {
      const auto begin = words.begin() + static_cast<std::ptrdiff_t>(kHead + first);
      return std::vector<std::uint32_t>(begin, begin + static_cast<std::ptrdiff_t>(length));
    };
    Lists found{.onModels = from(0, words[3]),
                .withLabels = from(words[3], words[7]),
                .moversOnly = from(slots.size() - words[11], words[11])};
    std::ranges::reverse(found.moversOnly);
    return found;
  }
};

TEST_F(StrokeLists, StrokesOnModelsBesideThemAndElsewhere) {
  const Lists lists =
      listsOf({kFar, kBeside, kDead, kOnModel, kBeyond, kOnMover, kOnReal, kOnModel}, true, false);
  EXPECT_THAT(lists.onModels, ElementsAre(3, 7));
  EXPECT_THAT(lists.withLabels, ElementsAre(1));
  EXPECT_THAT(lists.moversOnly, ElementsAre(0, 4, 5, 6));
}

TEST_F(StrokeLists, WithoutModelsNoneMeetsLabels) {
  const Lists lists = listsOf({kFar, kBeside, kOnModel, kOnMover}, false, false);
  EXPECT_THAT(lists.onModels, IsEmpty());
  EXPECT_THAT(lists.withLabels, IsEmpty());
  EXPECT_THAT(lists.moversOnly, ElementsAre(0, 1, 2, 3));
}

TEST_F(StrokeLists, SegmentsAreEverywhereButNotUnderMovers) {
  const Lists lists = listsOf({kOnMover, kFar, kBeyond, kOnModel}, true, true);
  EXPECT_THAT(lists.onModels, ElementsAre(3));
  EXPECT_THAT(lists.withLabels, ElementsAre(1, 2));
  EXPECT_THAT(lists.moversOnly, ElementsAre(0));
}

/// More than a group has invocations, so that each counts several.
TEST_F(StrokeLists, EachStrokeIsListedOnceAndInOrder) {
  constexpr std::array kKinds{kFar, kOnModel, kBeside, kDead, kOnMover};
  std::vector<Slot> slots;
  for (std::size_t i = 0; i < 1000; ++i) slots.push_back(kKinds.at(i * 7 % 11 % kKinds.size()));
  const Lists lists = listsOf(slots, true, false);
  std::map<std::uint32_t, int> times;
  for (const auto* list : {&lists.onModels, &lists.withLabels, &lists.moversOnly}) {
    EXPECT_TRUE(std::ranges::is_sorted(*list));
    for (const std::uint32_t slot : *list) ++times[slot];
  }
  for (std::uint32_t i = 0; i < slots.size(); ++i) EXPECT_EQ(times[i], slots[i].state != 0 ? 1 : 0);
}

}  // namespace
}  // namespace pleinair::marks
