// The six ways of thesis §6.1.2 to divide the work on tensors give the same tensors.
#include "pipeline/measure/baselines/work_divisions.h"

#include <random>
#include <set>

#include <gmock/gmock.h>

#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/measure/baselines_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::measure {
namespace {

using WorkDivisions = support::GlTest;

TEST_F(WorkDivisions, AllGiveTheProcessorsTensors) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {70, 38}});
  std::mt19937 random(3);
  for (auto& byte : image.plane(0)) byte = static_cast<std::uint8_t>(random());
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::baselinesShaders());
  const std::vector<WorkDivision> ways = timeWorkDivisions(library, image, 1);
  ASSERT_EQ(ways.size(), 6U);
  std::set<std::string> names;
  for (const WorkDivision& each : ways) {
    names.insert(each.name);
    EXPECT_LT(each.apart, 1e-4) << each.name;
    EXPECT_GT(each.gradientMs, 0.0) << each.name;
    EXPECT_GT(each.levelMs, 0.0) << each.name;
  }
  EXPECT_EQ(names.size(), 6U);
}

}  // namespace
}  // namespace pleinair::measure
