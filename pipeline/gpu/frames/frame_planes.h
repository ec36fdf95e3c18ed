#pragma once

#include <cstdint>

#include "hal/pixel_format.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// The texture of an image plane.
struct PlaneTexture {
  TextureFormat format = TextureFormat::kR8;
  hal::FrameSize size;
  TextureFilter filter = TextureFilter::kNearest;  ///< chroma is interpolated
  std::uint32_t fourcc = 0;                        ///< DRM's name of the layout
};

/// As it is uploaded.
PlaneTexture uploadedPlane(const hal::FrameFormat& format, int plane);
/// As it is imported: in the layouts that drivers import (R8, GR88, ABGR8888).
PlaneTexture importedPlane(const hal::FrameFormat& format, int plane);

}  // namespace pleinair::gpu
