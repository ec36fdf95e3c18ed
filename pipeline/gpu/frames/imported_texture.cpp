#include "pipeline/gpu/frames/imported_texture.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "pipeline/gpu/gl.h"

namespace pleinair::gpu {
namespace {

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool hasEgl(std::string_view extension) {
  const char* all = eglQueryString(eglGetCurrentDisplay(), EGL_EXTENSIONS);
  return all != nullptr &&
         fmt::format(" {} ", all).find(fmt::format(" {} ", extension)) != std::string::npos;
}

bool hasGl(std::string_view extension) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    if (reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i)) == extension) return true;
  }
  return false;
}

struct NamedModifiers {
  std::vector<std::uint64_t> all;       ///< that can be sampled, be it as an external texture only
  std::vector<std::uint64_t> ordinary;  ///< as a texture that can also be drawn into
};

/// The layouts that the driver names for a fourcc; none where it names none.
NamedModifiers namedModifiers(std::uint32_t fourcc) {
  if (!hasEgl("EGL_EXT_image_dma_buf_import_modifiers")) return {};
  const auto query = eglFunction<PFNEGLQUERYDMABUFMODIFIERSEXTPROC>("eglQueryDmaBufModifiersEXT");
  if (query == nullptr) return {};
  EGLDisplay display = eglGetCurrentDisplay();
  EGLint count = 0;
  if (!query(display, static_cast<EGLint>(fourcc), 0, nullptr, nullptr, &count)) return {};
  std::vector<EGLuint64KHR> modifiers(static_cast<std::size_t>(std::max(count, 0)));
  std::vector<EGLBoolean> areExternal(modifiers.size());
  if (modifiers.empty() || !query(display, static_cast<EGLint>(fourcc), count, modifiers.data(),
                                  areExternal.data(), &count)) {
    return {};
  }
  NamedModifiers named;
  for (std::size_t i = 0; i < modifiers.size(); ++i) {
    named.all.push_back(modifiers[i]);
    if (areExternal[i] == EGL_FALSE) named.ordinary.push_back(modifiers[i]);
  }
  return named;
}

hal::Error refused(std::string problem, int code) {
  return {.kind = hal::ErrorKind::kUnsupported,
          .subject = "GPU",
          .problem = std::move(problem),
          .remedy = {},
          .domain = hal::ErrorDomain::kEgl,
          .code = code};
}

/// The attributes of eglCreateImage() for a surface.
std::vector<EGLint> attributesOf(const hal::GpuSurface& of) {
  struct PlaneNames {
    EGLint fd, offset, pitch, modifierLow, modifierHigh;
  };
  constexpr std::array<PlaneNames, 4> kNames{
      PlaneNames{EGL_DMA_BUF_PLANE0_FD_EXT, EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                 EGL_DMA_BUF_PLANE0_PITCH_EXT, EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT,
                 EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT},
      {EGL_DMA_BUF_PLANE1_FD_EXT, EGL_DMA_BUF_PLANE1_OFFSET_EXT, EGL_DMA_BUF_PLANE1_PITCH_EXT,
       EGL_DMA_BUF_PLANE1_MODIFIER_LO_EXT, EGL_DMA_BUF_PLANE1_MODIFIER_HI_EXT},
      {EGL_DMA_BUF_PLANE2_FD_EXT, EGL_DMA_BUF_PLANE2_OFFSET_EXT, EGL_DMA_BUF_PLANE2_PITCH_EXT,
       EGL_DMA_BUF_PLANE2_MODIFIER_LO_EXT, EGL_DMA_BUF_PLANE2_MODIFIER_HI_EXT},
      {EGL_DMA_BUF_PLANE3_FD_EXT, EGL_DMA_BUF_PLANE3_OFFSET_EXT, EGL_DMA_BUF_PLANE3_PITCH_EXT,
       EGL_DMA_BUF_PLANE3_MODIFIER_LO_EXT, EGL_DMA_BUF_PLANE3_MODIFIER_HI_EXT}};
  const hal::Surface& surface = of.surface;
  std::vector<EGLint> attributes{EGL_WIDTH,
                                 of.bufferSize.width,
                                 EGL_HEIGHT,
                                 of.bufferSize.height,
                                 EGL_LINUX_DRM_FOURCC_EXT,
                                 static_cast<EGLint>(surface.fourcc)};
  const bool saysModifier = hasEgl("EGL_EXT_image_dma_buf_import_modifiers");
  for (int i = 0; i < surface.planeCount; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const hal::SurfacePlane& plane = surface.planes.at(at);
    attributes.insert(attributes.end(),
                      {kNames.at(at).fd, plane.dmaBuf, kNames.at(at).offset,
                       static_cast<EGLint>(plane.offsetBytes), kNames.at(at).pitch,
                       static_cast<EGLint>(plane.strideBytes)});
    if (!saysModifier) continue;
    attributes.insert(
        attributes.end(),
        {kNames.at(at).modifierLow, static_cast<EGLint>(surface.modifier & 0xFFFFFFFFU),
         kNames.at(at).modifierHigh, static_cast<EGLint>(surface.modifier >> 32U)});
  }
  attributes.push_back(EGL_NONE);
  return attributes;
}

using SetTarget = PFNGLEGLIMAGETARGETTEXTURE2DOESPROC;

SetTarget imageTarget() {
  return eglFunction<SetTarget>("glEGLImageTargetTexture2DOES");
}

/// A texture with the memory of an image. `error`: GL's, where the driver makes none.
TextureHandle textureOf(EGLImageKHR image, GLint filter, SetTarget setTarget, GLenum& error) {
  TextureHandle handle = TextureHandle::make();
  glBindTexture(GL_TEXTURE_2D, handle.get());
  setTarget(GL_TEXTURE_2D, image);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  error = glGetError();
  return handle;
}

/// A texture that shares a surface's memory. `what`: "a display's memory".
TextureHandle sharedTexture(const hal::GpuSurface& surface, GLint filter, const char* what) {
  const auto createImage = eglFunction<PFNEGLCREATEIMAGEKHRPROC>("eglCreateImageKHR");
  const auto destroyImage = eglFunction<PFNEGLDESTROYIMAGEKHRPROC>("eglDestroyImageKHR");
  const SetTarget setTarget = imageTarget();
  if (createImage == nullptr || destroyImage == nullptr || setTarget == nullptr) {
    throw hal::Failure(refused(fmt::format("shares no memory with {}", what), 0));
  }
  EGLDisplay display = eglGetCurrentDisplay();
  const EGLImageKHR image = createImage(display, EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr,
                                        attributesOf(surface).data());
  if (image == EGL_NO_IMAGE_KHR) {
    throw hal::Failure(refused(fmt::format("makes no image of {}", what), eglGetError()));
  }
  GLenum error = GL_NO_ERROR;
  TextureHandle handle = textureOf(image, filter, setTarget, error);
  destroyImage(display, image);  // the texture keeps the memory
  if (error != GL_NO_ERROR) {
    throw hal::Failure(
        refused(fmt::format("makes no texture of {}", what), static_cast<int>(error)));
  }
  return handle;
}

/// A texture of an output's, in the current context.
TextureHandle sharedTexture(const hal::SharedTexture& texture) {
  const SetTarget setTarget = imageTarget();
  if (setTarget == nullptr || texture.display != eglGetCurrentDisplay()) {
    throw hal::Failure(refused("shares no texture with the window", 0));
  }
  GLenum error = GL_NO_ERROR;
  TextureHandle handle = textureOf(texture.image.get(), GL_NEAREST, setTarget, error);
  if (error != GL_NO_ERROR) {
    throw hal::Failure(refused("makes no texture of the window's", static_cast<int>(error)));
  }
  return handle;
}

constexpr const char* kDisplayMemory = "a display's memory";
constexpr const char* kCameraMemory = "the camera's memory";

}  // namespace

ImportSupport importSupport(const GpuTestHook& testHook) {
  if (testHook.importSurface) return {.modifiers = {hal::kLinearModifier}, .problem = {}};
  const bool takesImages = hasGl("GL_OES_EGL_image");
  ImportSupport support;
  if (takesImages) support.eglDisplay = eglGetCurrentDisplay();
  if (!takesImages || !hasEgl("EGL_EXT_image_dma_buf_import")) {
    support.problem = "shares no memory with displays";
    return support;
  }
  support.modifiers = namedModifiers(hal::kXrgb8888).ordinary;
  // Drivers that name none take rows one after the other.
  if (support.modifiers.empty()) support.modifiers.push_back(hal::kLinearModifier);
  return support;
}

Texture importedTexture(const hal::GpuSurface& surface, const GpuTestHook& testHook) {
  if (testHook.importSurface) {
    const unsigned name = testHook.importSurface(surface);
    if (name == 0) throw hal::Failure(refused("makes no image of a display's memory", 0));
    return {TextureHandle(name), surface.bufferSize};
  }
  if (surface.texture.image) return {sharedTexture(surface.texture), surface.bufferSize};
  return {sharedTexture(surface, GL_NEAREST, kDisplayMemory), surface.bufferSize};
}

std::string planeImportProblem(std::uint32_t fourcc, std::uint64_t modifier,
                               const GpuTestHook& testHook) {
  std::vector<std::uint64_t> known;
  if (!testHook.importPlane) {
    if (!hasEgl("EGL_EXT_image_dma_buf_import") || !hasGl("GL_OES_EGL_image")) {
      return "the GPU's driver shares no memory with cameras (EGL_EXT_image_dma_buf_import)";
    }
    known = namedModifiers(fourcc).all;
  }
  // Drivers that name none take rows one after the other.
  if (modifier == hal::kLinearModifier && known.empty()) return {};
  if (std::ranges::find(known, modifier) != known.end()) return {};
  return fmt::format("the GPU's driver reads no memory of the camera's layout, {}",
                     hal::layoutText(modifier));
}

Texture importedPlaneTexture(const hal::DmaBufPlane& memory, const PlaneTexture& plane,
                             std::uint64_t modifier, std::uint32_t index,
                             const GpuTestHook& testHook) {
  hal::GpuSurface surface{.bufferSize = plane.size};
  surface.surface.id = hal::SurfaceId{index};
  surface.surface.fourcc = plane.fourcc;
  surface.surface.modifier = modifier;
  surface.surface.planes[0] = {
      .dmaBuf = memory.fd, .offsetBytes = memory.offsetBytes, .strideBytes = memory.strideBytes};
  if (testHook.importPlane) {
    const unsigned name = testHook.importPlane(surface);
    if (name == 0)
      throw hal::Failure(refused(fmt::format("makes no image of {}", kCameraMemory), 0));
    return {TextureHandle(name), plane.size, plane.format};
  }
  const GLint filter = plane.filter == TextureFilter::kLinear ? GL_LINEAR : GL_NEAREST;
  return {sharedTexture(surface, filter, kCameraMemory), plane.size, plane.format};
}

}  // namespace pleinair::gpu
