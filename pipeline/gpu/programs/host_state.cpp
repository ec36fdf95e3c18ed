#include "pipeline/gpu/programs/host_state.h"

#include <initializer_list>

#include "pipeline/gpu/programs/program.h"

namespace pleinair::gpu {
namespace {

void unbindAll() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  for (unsigned unit = 0; unit < kMaxTextureUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindSampler(unit, 0);
  }
  glActiveTexture(GL_TEXTURE0);
  for (unsigned i = 0; i < kMaxStorageBuffers; ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, 0);
  }
  for (unsigned i = 0; i < kMaxImages; ++i) {
    glBindImageTexture(i, 0, 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32UI);
  }
  for (const GLenum target :
       std::initializer_list<GLenum>{GL_ARRAY_BUFFER, GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,
                                     GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER}) {
    glBindBuffer(target, 0);
  }
}

void switchToDefaults() {
  for (const GLenum feature : std::initializer_list<GLenum>{
           GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_POLYGON_OFFSET_FILL, GL_RASTERIZER_DISCARD,
           GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_SCISSOR_TEST,
           GL_STENCIL_TEST}) {
    glDisable(feature);
  }
  glEnable(GL_DITHER);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDepthRangef(0.0F, 1.0F);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  for (const GLenum alignment :
       std::initializer_list<GLenum>{GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) {
    glPixelStorei(alignment, 4);
  }
  for (const GLenum layout : std::initializer_list<GLenum>{
           GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_UNPACK_ROW_LENGTH,
           GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS}) {
    glPixelStorei(layout, 0);
  }
}

}  // namespace

HostState::HostState() {
  glGetIntegerv(GL_VIEWPORT, viewport_.data());
  unbindAll();
  switchToDefaults();
}

HostState::~HostState() {
  unbindAll();
  switchToDefaults();
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
}

}  // namespace pleinair::gpu
