#include "tests/embedded_gpu/replay/replayed_state.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "hal/error.h"
#include "tests/embedded_gpu/gl_names.h"

namespace pleinair::embedded_gpu {
namespace {

using nlohmann::json;

constexpr GLsizei kSide = 16;  // of textures and targets
constexpr GLsizeiptr kBufferBytes = 1 << 20;
constexpr GLuint kStorageBuffers = gpu::kMaxStorageBuffers;
constexpr GLuint kUniformBlocks = gpu::kMaxUniformBlocks;

hal::Failure failure(std::string problem) {
  return hal::Failure({.kind = hal::ErrorKind::kInvalidInput,
                       .subject = "recorded state",
                       .problem = std::move(problem)});
}

void throwOnError(const char* when) {
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) throw failure(fmt::format("GL error 0x{:04x} {}", error, when));
}

void setEnabled(GLenum capability, bool isEnabled) {
  (isEnabled ? glEnable : glDisable)(capability);
}

}  // namespace

ReplayedState::ReplayedState()
    : buffer_(gpu::BufferHandle::make()),
      framebuffer_(gpu::FramebufferHandle::make()),
      vertexArray_(gpu::VertexArrayHandle::make()) {
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_.get());
  glBufferData(GL_SHADER_STORAGE_BUFFER, kBufferBytes, nullptr, GL_DYNAMIC_COPY);
}

GLuint ReplayedState::textureOf(const std::string& name, int which) {
  gpu::TextureHandle& texture = textures_[{name, which}];
  if (texture) return texture.get();
  // An imported buffer cannot be had here; RGBA8 is what most drivers read one as.
  const FormatName* format = formatOf(name == "external" ? "rgba8" : name);
  if (format == nullptr) throw failure(fmt::format("format {} is not known", name));
  texture = gpu::TextureHandle::make();
  glBindTexture(GL_TEXTURE_2D, texture.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, format->internal, kSide, kSide);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  throwOnError("making a texture");
  return texture.get();
}

void ReplayedState::bindUniforms(GLuint program, const json& state) {
  // Making a texture binds it to the active unit: all are made before any is bound to stay.
  for (const auto& [name, format] : state.at("textures").items()) {
    if (!format.get<std::string>().empty()) (void)textureOf(format);
  }
  if (state.contains("images")) {
    for (const auto& [name, image] : state.at("images").items()) {
      if (!image.at(0).get<std::string>().empty()) (void)textureOf(image.at(0));
    }
  }
  GLint unit = 0;
  for (const auto& [name, format] : state.at("textures").items()) {
    if (format.get<std::string>().empty()) continue;
    const GLuint texture = textureOf(format);
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform1i(glGetUniformLocation(program, name.c_str()), unit++);
  }
  if (!state.contains("images")) return;
  for (const auto& [name, image] : state.at("images").items()) {
    GLint binding = 0;
    glGetUniformiv(program, glGetUniformLocation(program, name.c_str()), &binding);
    const std::string format = image.at(0);
    if (format.empty()) continue;
    const GLuint texture = textureOf(format);
    glBindImageTexture(static_cast<GLuint>(binding), texture, 0, GL_FALSE, 0, image.at(1),
                       formatOf(format)->internal);
  }
}

void ReplayedState::bindTargets(const json& state) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get());
  std::array<GLenum, 4> buffers{GL_NONE, GL_NONE, GL_NONE, GL_NONE};
  const std::vector<std::string> targets = state.at("targets");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
    const bool isThere = i < targets.size() && !targets[i].empty();
    // A texture of its own for each output: none may be attached twice.
    const GLuint texture = isThere ? textureOf(targets[i], static_cast<int>(i) + 1) : 0;
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
    if (isThere) buffers.at(i) = attachment;
  }
  const std::string depth = state.at("depth");
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                         depth.empty() ? 0 : textureOf(depth), 0);
  glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  const GLenum status = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw failure(fmt::format("the target is incomplete (0x{:04x})", status));
  }
  glViewport(0, 0, kSide, kSide);
}

void ReplayedState::bindAttributes(const json& state) {
  vertexArray_ = gpu::VertexArrayHandle::make();
  glBindVertexArray(vertexArray_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer_.get());
  for (const auto& [index, attribute] : state.at("attributes").items()) {
    const auto i = static_cast<GLuint>(std::stoul(index));
    glEnableVertexAttribArray(i);
    if (attribute.at(3).get<int>() != 0) {
      glVertexAttribIPointer(i, attribute.at(0), attribute.at(1), attribute.at(4), nullptr);
    } else {
      glVertexAttribPointer(i, attribute.at(0), attribute.at(1), attribute.at(2).get<int>() != 0,
                            attribute.at(4), nullptr);
    }
    glVertexAttribDivisor(i, attribute.at(5));
  }
}

void ReplayedState::draw(const json& state) {
  setEnabled(GL_BLEND, state.contains("blend"));
  if (state.contains("blend")) {
    const json& blend = state.at("blend");
    glBlendFuncSeparate(blend.at(0), blend.at(1), blend.at(2), blend.at(3));
  }
  setEnabled(GL_DEPTH_TEST, state.contains("depth_test"));
  if (state.contains("depth_test")) {
    glDepthFunc(state.at("depth_test").at(0));
    glDepthMask(state.at("depth_test").at(1).get<int>() != 0);
  }
  setEnabled(GL_CULL_FACE, state.at("cull"));
  constexpr GLsizei kVertices = 6;
  if (state.at("indexed").get<bool>()) {
    glDrawElements(state.at("mode"), kVertices, GL_UNSIGNED_INT, nullptr);
  } else {
    glDrawArrays(state.at("mode"), 0, kVertices);
  }
}

void ReplayedState::use(gpu::Program& program, const json& state) {
  program.use();
  GLint current = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &current);
  if (state.contains("targets")) bindTargets(state);
  bindUniforms(static_cast<GLuint>(current), state);
  for (GLuint i = 0; i < kStorageBuffers; ++i) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffer_.get());
  }
  for (GLuint i = 0; i < kUniformBlocks; ++i) {
    glBindBufferBase(GL_UNIFORM_BUFFER, i, buffer_.get());
  }
  throwOnError("binding a state");
  if (state.contains("targets")) {
    bindAttributes(state);
    draw(state);
  } else {
    glDispatchCompute(1, 1, 1);
  }
  glFinish();
  throwOnError("running a program");
}

}  // namespace pleinair::embedded_gpu
