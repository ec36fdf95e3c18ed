#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/scene/render/ar_frame_renderer.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::scene {

/// A GL test with the scene shaders, a plain camera image, and window depth read back.
class SceneGlTest : public support::GlTest {
 protected:
  static constexpr std::array<std::uint8_t, 3> kGround{30, 60, 90};

  void SetUp() override {
    GlTest::SetUp();
    library_.add(gpu::gpuShaders());
    library_.add(gpu::sceneShaders());
    library_.add(kTestShaders);
  }

  static gpu::Texture plainPicture(hal::FrameSize size) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
    const auto bytes = image.plane(0);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = kGround[i % 3];
    return support::textureOf(image.view());
  }

  static SceneModel placed(ModelSource source, std::optional<int> tagId = std::nullopt) {
    SceneModel model;
    model.model = std::make_shared<const Model>(modelOf(source).value());
    model.source = std::move(source);
    model.tagId = tagId;
    return model;
  }

  const ArFrame& compose(ArFrameRenderer& renderer, const gpu::Texture& picture,
                         const tracking::CameraModel& camera, const PoseSet& poses) {
    return renderer.compose(picture, camera, poses, 7, hal::TimePoint(hal::Duration(9)));
  }

  /// Window depth in [0, 1], exact: its bits are read through an integer target.
  std::vector<float> readDepth(const gpu::Texture& depth) {
    gpu::Texture bits(gpu::TextureFormat::kR32ui, depth.size());
    const gpu::RenderTarget target({&bits});
    gpu::Program pass = library_.fragmentPass("tests/depth_bits.frag");
    pass.use().texture("depth", depth).drawFullscreen(target);
    std::vector<float> values;
    for (const std::uint32_t each : support::readR32ui(bits)) {
      values.push_back(std::bit_cast<float>(each));
    }
    return values;
  }

  gpu::ShaderLibrary library_;

 private:
  static constexpr std::array<gpu::EmbeddedShader, 1> kTestShaders{
      {{"tests/depth_bits.frag",
        "uniform sampler2D depth;\n"
        "layout(location = 0) out uint bits;\n"
        "void main() {\n"
        "  bits = floatBitsToUint(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r);\n"
        "}\n"}}};
};

}  // namespace pleinair::scene
