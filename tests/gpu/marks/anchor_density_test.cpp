// The thesis's figure 28 as figures: anchors are spread evenly over what a model shows, near and
// far; points that were drawn on its surface are not.
#include <cmath>
#include <memory>

#include <glm/ext/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/description/model_source.h"
#include "tests/reports/anchors/anchor_stage.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

using AnchorDensity = support::GlTest;

glm::dmat4 boxAt(double metres) {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, metres}), 2.2, {0.8, 0.5, 0.1});
}

TEST_F(AnchorDensity, IsEvenNearAndFarWhereAreaSamplingIsNot) {
  AnchorStage stage(std::make_shared<const scene::Model>(
      scene::modelOf(scene::BoxSource{{0.3, 0.2, 0.1}}).value()));
  stage.advance(boxAt(0.45));
  const CellGrid nearGrid = stage.grid();
  ASSERT_GT(nearGrid.cells(), 500U);
  const CellCounts ours = nearGrid.count(stage.places());
  EXPECT_NEAR(ours.mean, 2.0, 0.05);
  EXPECT_LT(ours.spread, 0.3);
  EXPECT_EQ(ours.empty, 0.0);

  // As many in the mean, drawn on the surface.
  const std::vector<SurfaceSample> many = sampleByArea(stage.triangles(), 20'000, 1);
  const double mean = nearGrid.count(stage.seen(many)).mean;
  ASSERT_GT(mean, 2.0);
  const auto count = static_cast<std::size_t>(std::lround(20'000.0 * ours.mean / mean));
  const std::span<const SurfaceSample> samples = std::span(many).first(count);
  const CellCounts drawn = nearGrid.count(stage.seen(samples));
  EXPECT_NEAR(drawn.mean, ours.mean, 0.2);
  EXPECT_GT(drawn.spread, 1.2);
  EXPECT_GT(drawn.empty, 0.08) << "e⁻² of all would be empty of points that know nothing of cells";

  for (int i = 1; i <= 10; ++i) stage.advance(boxAt(0.45 * std::pow(2.5, i / 10.0)));
  for (int i = 0; i < 8; ++i) stage.advance(boxAt(0.45 * 2.5));
  const CellGrid farGrid = stage.grid();
  ASSERT_GT(farGrid.cells(), 20U);
  const CellCounts far = farGrid.count(stage.places());
  EXPECT_EQ(far.empty, 0.0);
  EXPECT_LE(far.most, 6) << "a cell at a corner shows three faces";
  EXPECT_GT(farGrid.count(stage.seen(samples)).mean, 8.0) << "they crowd";
}

}  // namespace
}  // namespace pleinair::marks
