#include "hal/outputs/window/lent_textures.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <string_view>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>

#include "hal/outputs/window/sdl_video.h"

namespace pleinair::hal::window {
namespace {

Error refusal(std::string problem, ErrorKind kind = ErrorKind::kUnsupported) {
  return {.kind = kind, .subject = "window", .problem = std::move(problem), .remedy = {}};
}

bool hasExtension(EGLDisplay display, std::string_view name) {
  const char* const all = eglQueryString(display, EGL_EXTENSIONS);
  return all != nullptr &&
         (" " + std::string(all) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Of the current context: "llvmpipe (LLVM 15.0.6, 256 bits)".
std::string deviceName() {
  const GLubyte* const name = glGetString(GL_RENDERER);
  return name == nullptr ? "" : reinterpret_cast<const char*>(name);
}

/// Nothing of SDL's may be called once the server is gone.
void destroyTexture(SDL_Texture* texture) {
  if (texture != nullptr && !display_connection::isLost()) SDL_DestroyTexture(texture);
}

}  // namespace

Result<void*> LentTextures::displayOf(SDL_Renderer* renderer, bool mayBeSoftware) {
  SDL_RendererInfo info{};
  SDL_GetRendererInfo(renderer, &info);
  const std::string name = info.name == nullptr ? "" : info.name;
  if (name != "opengles2") {
    return tl::unexpected(refusal("is drawn by SDL's \"" + name + "\", which shares no textures"));
  }
  EGLDisplay display = eglGetCurrentDisplay();
  const bool shares = display != EGL_NO_DISPLAY && hasExtension(display, "EGL_KHR_image_base") &&
                      hasExtension(display, "EGL_KHR_gl_texture_2D_image");
  if (!shares) return tl::unexpected(refusal("is drawn by a driver that shares no textures"));
  const std::string device = deviceName();
  if (!mayBeSoftware && device.find("pipe") != std::string::npos) {
    return tl::unexpected(refusal("is drawn by software (" + device +
                                  "), which is faster with copies; scan_out = \"direct\" insists"));
  }
  return display;
}

LentTextures::~LentTextures() {
  clear();
}

void LentTextures::clear() {
  for (Lent& each : lent_) forgetSync(each);
  lent_.clear();
  seen_.reset();
}

void LentTextures::forgetSync(Lent& lent) const {
  EGLSyncKHR sync = std::exchange(lent.done, nullptr);
  if (sync == EGL_NO_SYNC_KHR || display_connection::isLost()) return;
  eglFunction<PFNEGLDESTROYSYNCKHRPROC>("eglDestroySyncKHR")(display_, sync);
}

Result<std::vector<GpuSurface>> LentTextures::lend(SDL_Renderer* renderer, FrameSize size,
                                                   std::size_t count) {
  const std::shared_ptr<SDL_Texture> seen = seen_;
  clear();
  seen_ = seen;
  size_ = size;
  std::vector<GpuSurface> surfaces;
  for (std::size_t i = 0; i < count; ++i) {
    Result<GpuSurface> made = make(renderer, size, SurfaceId{static_cast<std::uint32_t>(i)});
    if (!made) {
      lent_.clear();
      return tl::unexpected(std::move(made.error()));
    }
    surfaces.push_back(*std::move(made));
  }
  return surfaces;
}

Result<GpuSurface> LentTextures::make(SDL_Renderer* renderer, FrameSize size, SurfaceId id) {
  Lent lent;
  lent.texture = {SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC,
                                    size.width, size.height),
                  destroyTexture};
  // This also makes the renderer's context current.
  if (lent.texture == nullptr || SDL_GL_BindTexture(lent.texture.get(), nullptr, nullptr) != 0) {
    return tl::unexpected(
        refusal(std::string("has no texture to lend: ") + SDL_GetError(), ErrorKind::kNoSpace));
  }
  SDL_SetTextureBlendMode(lent.texture.get(), SDL_BLENDMODE_NONE);
  SDL_SetTextureScaleMode(lent.texture.get(), SDL_ScaleModeLinear);
  GLint name = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &name);
  lent.name = static_cast<std::uint32_t>(name);
  EGLDisplay display = eglGetCurrentDisplay();
  const auto destroyImage = eglFunction<PFNEGLDESTROYIMAGEKHRPROC>("eglDestroyImageKHR");
  EGLImageKHR image = eglFunction<PFNEGLCREATEIMAGEKHRPROC>("eglCreateImageKHR")(
      display, eglGetCurrentContext(), EGL_GL_TEXTURE_2D_KHR,
      reinterpret_cast<EGLClientBuffer>(static_cast<std::uintptr_t>(lent.name)), nullptr);
  const EGLint error = eglGetError();
  SDL_GL_UnbindTexture(lent.texture.get());
  if (image == EGL_NO_IMAGE_KHR) {
    return tl::unexpected(refusal("shares no texture (EGL error " + std::to_string(error) + ")"));
  }
  display_ = display;
  hasFences_ = hasExtension(display, "EGL_KHR_fence_sync");
  lent_.push_back(std::move(lent));
  GpuSurface surface{.surface = {}, .bufferSize = size};
  surface.surface.id = id;
  surface.surface.format = {.pixelFormat = PixelFormat::kRgba8, .size = size};
  surface.surface.fourcc = kXbgr8888;
  surface.surface.planeCount = 0;
  surface.texture.display = display;
  surface.texture.image = {image,
                           [=](void* each) { static_cast<void>(destroyImage(display, each)); }};
  return surface;
}

bool LentTextures::hasLeft(Lent& lent) const {
  if (lent.done == EGL_NO_SYNC_KHR) return true;
  const auto wait = eglFunction<PFNEGLCLIENTWAITSYNCKHRPROC>("eglClientWaitSyncKHR");
  if (wait(display_, lent.done, EGL_SYNC_FLUSH_COMMANDS_BIT_KHR, 0) == EGL_TIMEOUT_EXPIRED_KHR) {
    return false;
  }
  forgetSync(lent);
  return true;
}

std::optional<SurfaceId> LentTextures::acquire() {
  for (std::size_t i = 0; i < lent_.size(); ++i) {
    Lent& each = lent_[i];
    if (each.state == State::kLeaving && hasLeft(each)) each.state = State::kFree;
    if (each.state != State::kFree) continue;
    each.state = State::kAcquired;
    return SurfaceId{static_cast<std::uint32_t>(i)};
  }
  return std::nullopt;
}

void LentTextures::hide() {
  for (Lent& each : lent_) {
    if (each.state == State::kSeen) each.state = State::kReplaced;
  }
  seen_.reset();
}

void LentTextures::show(SurfaceId surface) {
  hide();
  Lent& lent = lent_.at(static_cast<std::size_t>(surface));
  assert(lent.state == State::kAcquired);
  lent.state = State::kSeen;
  seen_ = lent.texture;
}

void LentTextures::drawn() {
  for (Lent& each : lent_) {
    if (each.state != State::kReplaced) continue;
    each.state = State::kLeaving;
    if (hasFences_) {
      const auto createSync = eglFunction<PFNEGLCREATESYNCKHRPROC>("eglCreateSyncKHR");
      each.done = createSync(display_, EGL_SYNC_FENCE_KHR, nullptr);
    }
    if (each.done == EGL_NO_SYNC_KHR) glFinish();
  }
}

Result<Image> LentTextures::copy(SDL_Renderer* renderer, SurfaceId surface) {
  const Lent& lent = lent_.at(static_cast<std::size_t>(surface));
  if (SDL_RenderFlush(renderer) != 0 ||
      SDL_GL_BindTexture(lent.texture.get(), nullptr, nullptr) != 0) {
    return tl::unexpected(refusal(std::string("cannot read a texture: ") + SDL_GetError()));
  }
  Image image({.pixelFormat = PixelFormat::kRgba8, .size = size_});
  GLint bound = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, lent.name, 0);
  const bool isReadable = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (isReadable) {
    glReadPixels(0, 0, size_.width, size_.height, GL_RGBA, GL_UNSIGNED_BYTE, image.plane(0).data());
  }
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
  glDeleteFramebuffers(1, &framebuffer);
  SDL_GL_UnbindTexture(lent.texture.get());
  if (!isReadable) return tl::unexpected(refusal("has textures that cannot be read"));
  return image;
}

}  // namespace pleinair::hal::window
