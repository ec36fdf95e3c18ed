#include "pipeline/gpu/program.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include <glm/gtc/type_ptr.hpp>

namespace pleinair::gpu {
namespace {

bool isImageFormat(TextureFormat format) {
  return format == TextureFormat::kRgba8 || format == TextureFormat::kRgba16f ||
         format == TextureFormat::kRgba32f || format == TextureFormat::kR32f ||
         format == TextureFormat::kR32ui;
}

[[maybe_unused]] bool isCurrent(const ProgramHandle& program) {
  auto current = static_cast<GLint>(program.get());  // a lost context answers nothing
  glGetIntegerv(GL_CURRENT_PROGRAM, &current);
  return program && static_cast<GLuint>(current) == program.get();
}

[[maybe_unused]] bool hasGroupSize(const ProgramHandle& program, glm::ivec2 size) {
  std::array<GLint, 3> local{size.x, size.y, 1};  // a lost context answers nothing
  glGetProgramiv(program.get(), GL_COMPUTE_WORK_GROUP_SIZE, local.data());
  return local[0] == size.x && local[1] == size.y && local[2] == 1;
}

GLuint groups(int items, int groupSize) {
  return static_cast<GLuint>((items + groupSize - 1) / groupSize);
}

}  // namespace

Program::Program(ProgramHandle handle, std::string label)
    : handle_(std::move(handle)),
      label_(std::move(label)),
      emptyVertexArray_(VertexArrayHandle::make()) {
  GLint count = 0;
  glGetProgramiv(handle_.get(), GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::array<GLchar, 128> name{};
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(handle_.get(), i, static_cast<GLsizei>(name.size()), nullptr, &size, &type,
                       name.data());
    uniforms_.push_back({name.data(), glGetUniformLocation(handle_.get(), name.data())});
  }
}

GLint Program::location(std::string_view uniform) const {
  assert(isCurrent(handle_));
  const auto found = std::ranges::find(uniforms_, uniform, &Uniform::name);
  return found == uniforms_.end() ? -1 : found->location;
}

Program& Program::use() {
  glUseProgram(handle_.get());
  nextTextureUnit_ = 0;
  return *this;
}

Program& Program::set(std::string_view uniform, int value) {
  glUniform1i(location(uniform), value);
  return *this;
}
Program& Program::set(std::string_view uniform, unsigned value) {
  glUniform1ui(location(uniform), value);
  return *this;
}
Program& Program::set(std::string_view uniform, float value) {
  glUniform1f(location(uniform), value);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::ivec2 value) {
  glUniform2i(location(uniform), value.x, value.y);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::vec2 value) {
  glUniform2f(location(uniform), value.x, value.y);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::vec3 value) {
  glUniform3f(location(uniform), value.x, value.y, value.z);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::vec4 value) {
  glUniform4f(location(uniform), value.x, value.y, value.z, value.w);
  return *this;
}
Program& Program::set(std::string_view uniform, const glm::mat3& value) {
  glUniformMatrix3fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
  return *this;
}
Program& Program::set(std::string_view uniform, const glm::mat4& value) {
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
  return *this;
}

Program& Program::texture(std::string_view sampler, const Texture& texture) {
  assert(nextTextureUnit_ < kMaxTextureUnits);
  glActiveTexture(GL_TEXTURE0 + nextTextureUnit_);
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glUniform1i(location(sampler), static_cast<GLint>(nextTextureUnit_));
  glActiveTexture(GL_TEXTURE0);
  ++nextTextureUnit_;
  return *this;
}

Program& Program::storage(unsigned binding, const Buffer& buffer) {
  assert(binding < kMaxStorageBuffers);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
  return *this;
}

Program& Program::uniformBlock(unsigned binding, const Buffer& buffer, std::size_t offsetBytes,
                               std::size_t sizeBytes) {
  assert(binding < kMaxUniformBlocks && offsetBytes % kUniformAlignment == 0);
  assert(offsetBytes + sizeBytes <= buffer.sizeBytes());
  glBindBufferRange(GL_UNIFORM_BUFFER, binding, buffer.name(), static_cast<GLintptr>(offsetBytes),
                    static_cast<GLsizeiptr>(sizeBytes));
  return *this;
}

Program& Program::image(unsigned binding, const Texture& texture, ImageAccess access) {
  assert(binding < kMaxImages && isImageFormat(texture.format()));
  assert(access != ImageAccess::kReadWrite || texture.format() == TextureFormat::kR32f ||
         texture.format() == TextureFormat::kR32ui);
  const GLenum mode = access == ImageAccess::kRead    ? GL_READ_ONLY
                      : access == ImageAccess::kWrite ? GL_WRITE_ONLY
                                                      : GL_READ_WRITE;
  glBindImageTexture(binding, texture.name(), 0, GL_FALSE, 0, mode,
                     glFormat(texture.format()).internal);
  return *this;
}

void Program::drawFullscreen(const RenderTarget& target) {
  target.beginDiscarding();
  drawTriangle();
}

void Program::drawArea(const RenderTarget& target, glm::ivec2 origin, hal::FrameSize size) {
  assert(origin.x >= 0 && origin.y >= 0 && origin.x + size.width <= target.size().width &&
         origin.y + size.height <= target.size().height);
  target.beginKeeping();
  glViewport(origin.x, origin.y, size.width, size.height);
  drawTriangle();
}

void Program::drawTriangle() {
  assert(isCurrent(handle_));
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(emptyVertexArray_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

void Program::dispatch(glm::ivec2 items, glm::ivec2 groupSize, GLbitfield barriers) {
  assert(items.x > 0 && items.y > 0);
  assert(isCurrent(handle_) && hasGroupSize(handle_, groupSize));
  assert(groups(items.x, groupSize.x) <= kMaxGroups && groups(items.y, groupSize.y) <= kMaxGroups);
  glDispatchCompute(groups(items.x, groupSize.x), groups(items.y, groupSize.y), 1);
  glMemoryBarrier(barriers);
}

}  // namespace pleinair::gpu
