#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/error.h"
#include "hal/frame_image.h"
#include "hal/surface.h"
#include "pipeline/gpu/frames/frame_planes.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// The layouts of XRGB8888 (modifiers of drm_fourcc.h) that the current context can draw into where
/// another has made the memory (EGL_EXT_image_dma_buf_import, GL_OES_EGL_image).
struct ImportSupport {
  std::vector<std::uint64_t> modifiers;
  std::string problem;         ///< why there are none
  void* eglDisplay = nullptr;  ///< whose shared textures it can draw into, too; null: of none
  std::string apartBecause;    ///< why that is not a window's (ContextInfo::apartBecause)
};
ImportSupport importSupport(const GpuTestHook& testHook = {});

/// A surface of an output as a texture of its buffer's size, which shares the surface's memory:
/// for drawing. A surface that is a texture keeps its memory. Otherwise, the surface's descriptors
/// may be closed afterwards. That there is no error promises little: what is drawn may not arrive,
/// and software drivers have crashed (ImportTrial). Throws hal::Failure (kUnsupported).
Texture importedTexture(const hal::GpuSurface& surface, const GpuTestHook& testHook = {});

/// Why the current context imports no plane of this layout for reading; empty: it may.
std::string planeImportProblem(std::uint32_t fourcc, std::uint64_t modifier,
                               const GpuTestHook& testHook = {});
/// A plane of a camera's buffer `index` as a texture that shares its memory: for reading. The
/// descriptor may be closed afterwards. That there is no error promises little (CameraFrames
/// compares pixels). Throws hal::Failure (kUnsupported).
Texture importedPlaneTexture(const hal::DmaBufPlane& memory, const PlaneTexture& plane,
                             std::uint64_t modifier, std::uint32_t index,
                             const GpuTestHook& testHook = {});

}  // namespace pleinair::gpu
