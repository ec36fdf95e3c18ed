#include "pipeline/gpu/render_target.h"

#include <array>
#include <cassert>

#include <fmt/format.h>

#include "hal/error.h"
#include "pipeline/gpu/gpu_memory.h"

namespace pleinair::gpu {
namespace {

GLenum attachment(int i) {
  return GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
}

hal::Error incomplete(hal::FrameSize size, GLenum status) {
  return {.kind = hal::ErrorKind::kUnsupported,
          .subject = "GPU",
          .problem = fmt::format("cannot draw a {}x{} picture: framebuffer status 0x{:04x}",
                                 size.width, size.height, status),
          .remedy = "update the GPU's driver",
          .domain = hal::ErrorDomain::kGl,
          .code = static_cast<int>(status)};
}

}  // namespace

RenderTarget::RenderTarget(std::initializer_list<const Texture*> colours, const Texture* depth)
    : handle_(FramebufferHandle::make()),
      colourCount_(static_cast<int>(colours.size())),
      hasDepth_(depth != nullptr) {
  assert(colourCount_ >= 1 && colourCount_ <= static_cast<int>(kMaxColours));
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.get());
  std::array<GLenum, kMaxColours> drawBuffers{};
  int i = 0;
  for (const Texture* colour : colours) {
    assert(isRenderable(colour->format()) && colour->format() != TextureFormat::kDepth24);
    assert(i == 0 || colour->size() == size_);
    size_ = colour->size();
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment(i), GL_TEXTURE_2D, colour->name(), 0);
    drawBuffers[static_cast<std::size_t>(i)] = attachment(i);
    colours_[static_cast<std::size_t>(i)] = {.texture = colour->name(), .format = colour->format()};
    ++i;
  }
  if (depth != nullptr) {
    assert(depth->format() == TextureFormat::kDepth24 && depth->size() == size_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth->name(), 0);
  }
  glDrawBuffers(colourCount_, drawBuffers.data());
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  checkMemory(fmt::format("drawing a {}x{} picture", size_.width, size_.height));
  if (status != GL_FRAMEBUFFER_COMPLETE) throw hal::Failure(incomplete(size_, status));
}

void RenderTarget::beginDiscarding() const {
  beginKeeping();
  std::array<GLenum, kMaxColours + 1> attachments{};
  int count = 0;
  for (; count < colourCount_; ++count) {
    attachments[static_cast<std::size_t>(count)] = attachment(count);
  }
  if (hasDepth_) attachments[static_cast<std::size_t>(count++)] = GL_DEPTH_ATTACHMENT;
  glInvalidateFramebuffer(GL_FRAMEBUFFER, count, attachments.data());
}

void RenderTarget::beginKeeping() const {
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.get());
  glViewport(0, 0, size_.width, size_.height);
}

void RenderTarget::bindAsImages(std::span<const TextureFormat> formats) const {
  assert(formats.size() == static_cast<std::size_t>(colourCount_));
  for (std::size_t i = 0; i < formats.size(); ++i) {
    assert(colours_[i].format == formats[i]);
    glBindImageTexture(static_cast<GLuint>(i), colours_[i].texture, 0, GL_FALSE, 0, GL_WRITE_ONLY,
                       glFormat(formats[i]).internal);
  }
}

void RenderTarget::clearColour(int target, glm::vec4 colour) const {
  glClearBufferfv(GL_COLOR, target, &colour[0]);
}

void RenderTarget::clearUnsigned(int target, glm::uvec4 value) const {
  glClearBufferuiv(GL_COLOR, target, &value[0]);
}

void RenderTarget::clearDepth() const {
  const GLfloat farthest = 1.0F;
  glClearBufferfv(GL_DEPTH, 0, &farthest);
}

void RenderTarget::discardDepth() const {
  const GLenum depth = GL_DEPTH_ATTACHMENT;
  glInvalidateFramebuffer(GL_FRAMEBUFFER, 1, &depth);
}

}  // namespace pleinair::gpu
