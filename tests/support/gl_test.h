#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "hal/image.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::support {

/// A test with its own OpenGL ES context, and with helpers that transfer images to and from
/// textures. Skips with the reason if no context can be created.
class GlTest : public testing::Test {
 protected:
  void SetUp() override;

  /// Outlives the members of derived fixtures, whose GL objects go while it is current.
  std::unique_ptr<gpu::EglContext> context_;
};

/// An RGBA8 texture (LINEAR) that holds an RGB8 or RGBA8 image.
gpu::Texture textureOf(const hal::ImageView& image);
/// Reads a texture back, blocking. For tests only.
hal::Image readRgba8(const gpu::Texture& texture);
std::vector<std::uint32_t> readR32ui(const gpu::Texture& texture);
/// Reads a floating-point texture (kRgba16f, kRg16f, …) as 4 floats per pixel.
std::vector<float> readRgba32f(const gpu::Texture& texture);
/// Reads a whole buffer of T.
template <class T>
std::vector<T> readBuffer(const gpu::Buffer& buffer) {
  std::vector<T> items(buffer.sizeBytes() / sizeof(T));
  EXPECT_TRUE(buffer.read(std::as_writable_bytes(std::span(items))));
  return items;
}

}  // namespace pleinair::support
