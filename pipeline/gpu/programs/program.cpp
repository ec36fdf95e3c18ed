#include "pipeline/gpu/programs/program.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/type_ptr.hpp>

#include "hal/error.h"

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

/// The local_size of a compute program; 1x1 for others.
glm::ivec2 groupSizeOf(const ProgramHandle& program) {
  std::array<GLint, 3> local{1, 1, 1};  // a lost context answers nothing
  glGetProgramiv(program.get(), GL_COMPUTE_WORK_GROUP_SIZE, local.data());
  return glm::max(glm::ivec2(local[0], local[1]), glm::ivec2(1));
}

/// "pipeline/styles/watercolor/shaders/guide.frag" is timed as "watercolor: guide"; flags stay.
std::string passOf(const std::string& label) {
  const std::size_t flags = std::min(label.find(' '), label.size());
  const std::string path = label.substr(0, flags);
  const std::size_t slash = path.rfind('/');
  const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  std::string folder = slash == std::string::npos ? "" : path.substr(0, slash);
  if (folder.ends_with("/shaders")) folder.resize(folder.size() - std::string("/shaders").size());
  folder = folder.substr(folder.rfind('/') + 1);  // npos + 1 is 0
  return (folder.empty() ? "" : folder + ": ") + file.substr(0, file.find('.')) +
         label.substr(flags);
}

const char* nameOf(ShaderInput::Kind kind) {
  switch (kind) {
    case ShaderInput::Kind::kUniform:
      return "uniform";
    case ShaderInput::Kind::kSampler:
      return "sampler";
    case ShaderInput::Kind::kImage:
      return "image";
    case ShaderInput::Kind::kUniformBlock:
      return "uniform block";
    case ShaderInput::Kind::kStorageBlock:
      return "storage block";
  }
  return "";
}

}  // namespace

struct Program::Linked {
  ProgramHandle handle;
  std::string label;
  std::string pass;
  std::vector<Input> inputs;
  PassTargets targets;  // a full-screen pass in its compute form writes to these formats
  glm::ivec2 groupSize{1};
  ListDispatch listDispatch = ListDispatch::kIndirect;
  VertexArrayHandle emptyVertexArray;

  void findLocations();
};

Program::Program(ProgramHandle handle, ProgramKind kind, std::string label,
                 std::vector<ShaderInput> inputs, TimerSlot timer, PassTargets targets,
                 ListDispatch listDispatch)
    : timer_(std::move(timer)) {
  auto linked = std::make_shared<Linked>();
  linked->handle = std::move(handle);
  linked->pass = passOf(label);
  linked->label = std::move(label);
  for (ShaderInput& input : inputs) linked->inputs.push_back({.declared = std::move(input)});
  linked->findLocations();
  linked->targets = std::move(targets);
  if (kind == ProgramKind::kCompute) linked->groupSize = groupSizeOf(linked->handle);
  linked->listDispatch = listDispatch;
  linked->emptyVertexArray = VertexArrayHandle::make();
  linked_ = std::move(linked);
}

const std::string& Program::label() const {
  return linked_->label;
}

const std::string& Program::pass() const {
  return linked_->pass;
}

glm::ivec2 Program::groupSize() const {
  return linked_->groupSize;
}

void Program::Linked::findLocations() {
  GLint count = 0;
  glGetProgramiv(handle.get(), GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::array<GLchar, 128> text{};
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(handle.get(), i, static_cast<GLsizei>(text.size()), nullptr, &size, &type,
                       text.data());
    const GLint location = glGetUniformLocation(handle.get(), text.data());
    if (location < 0) continue;  // of a block
    std::string name = text.data();
    if (name.ends_with("[0]")) name.resize(name.size() - 3);
    for (Input& input : inputs) {
      if (input.declared.name == name) input.location = location;
    }
  }
}

void Program::refuse(const std::string& problem) const {
  std::vector<std::string> names;
  for (const Input& each : linked_->inputs) {
    names.push_back(fmt::format("{} {}", nameOf(each.declared.kind), each.declared.name));
  }
  throw hal::Failure(
      {.kind = hal::ErrorKind::kInternal,
       .subject = fmt::format("program {}", linked_->label),
       .problem = problem,
       .remedy = fmt::format(
           "its shaders declare {}",
           names.empty() ? "nothing to set" : fmt::format("{}", fmt::join(names, ", ")))});
}

const Program::Input& Program::input(ShaderInput::Kind kind, std::string_view name) const {
  assert(isCurrent(linked_->handle));
  for (const Input& each : linked_->inputs) {
    if (each.declared.kind == kind && each.declared.name == name) return each;
  }
  refuse(fmt::format("has no {} \"{}\"", nameOf(kind), name));
}

bool Program::hasUniform(std::string_view name) const {
  return std::ranges::any_of(linked_->inputs, [&](const Input& each) {
    return each.declared.name == name && (each.declared.kind == ShaderInput::Kind::kUniform ||
                                          each.declared.kind == ShaderInput::Kind::kSampler);
  });
}

GLint Program::location(std::string_view uniform, std::string_view type) const {
  const Input& found = input(ShaderInput::Kind::kUniform, uniform);
  const std::string& declared = found.declared.type;
  if (declared != type && (declared != "bool" || type != "int")) {
    refuse(fmt::format("has a {} {}, which cannot be set to a {}", declared, uniform, type));
  }
  return found.location;
}

unsigned Program::binding(ShaderInput::Kind kind, std::string_view name) const {
  const Input& found = input(kind, name);
  if (found.declared.binding < 0) {
    refuse(fmt::format("has a {} {} whose layout names no binding", nameOf(kind), name));
  }
  return static_cast<unsigned>(found.declared.binding);
}

Program& Program::use() {
  glUseProgram(linked_->handle.get());
  nextTextureUnit_ = 0;
  return *this;
}

Program& Program::set(std::string_view uniform, int value) {
  glUniform1i(location(uniform, "int"), value);
  return *this;
}
Program& Program::set(std::string_view uniform, unsigned value) {
  glUniform1ui(location(uniform, "uint"), value);
  return *this;
}
Program& Program::set(std::string_view uniform, float value) {
  glUniform1f(location(uniform, "float"), value);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::ivec2 value) {
  glUniform2i(location(uniform, "ivec2"), value.x, value.y);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::vec2 value) {
  glUniform2f(location(uniform, "vec2"), value.x, value.y);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::vec3 value) {
  glUniform3f(location(uniform, "vec3"), value.x, value.y, value.z);
  return *this;
}
Program& Program::set(std::string_view uniform, glm::vec4 value) {
  glUniform4f(location(uniform, "vec4"), value.x, value.y, value.z, value.w);
  return *this;
}
Program& Program::set(std::string_view uniform, std::span<const glm::vec4> values) {
  glUniform4fv(location(uniform, "vec4"), static_cast<GLsizei>(values.size()),
               glm::value_ptr(values.front()));
  return *this;
}
Program& Program::set(std::string_view uniform, const glm::mat3& value) {
  glUniformMatrix3fv(location(uniform, "mat3"), 1, GL_FALSE, glm::value_ptr(value));
  return *this;
}
Program& Program::set(std::string_view uniform, const glm::mat4& value) {
  glUniformMatrix4fv(location(uniform, "mat4"), 1, GL_FALSE, glm::value_ptr(value));
  return *this;
}

Program& Program::texture(std::string_view sampler, const Texture& texture) {
  assert(nextTextureUnit_ < kMaxTextureUnits);
  glActiveTexture(GL_TEXTURE0 + nextTextureUnit_);
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glUniform1i(input(ShaderInput::Kind::kSampler, sampler).location,
              static_cast<GLint>(nextTextureUnit_));
  glActiveTexture(GL_TEXTURE0);
  ++nextTextureUnit_;
  return *this;
}

Program& Program::storage(std::string_view block, const Buffer& buffer) {
  const unsigned place = binding(ShaderInput::Kind::kStorageBlock, block);
  assert(place < kMaxStorageBuffers);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, place, buffer.name());
  return *this;
}

Program& Program::uniformBlock(std::string_view block, const Buffer& buffer,
                               std::size_t offsetBytes, std::size_t sizeBytes) {
  const unsigned place = binding(ShaderInput::Kind::kUniformBlock, block);
  assert(place < kMaxUniformBlocks && offsetBytes % kUniformAlignment == 0);
  assert(offsetBytes + sizeBytes <= buffer.sizeBytes());
  glBindBufferRange(GL_UNIFORM_BUFFER, place, buffer.name(), static_cast<GLintptr>(offsetBytes),
                    static_cast<GLsizeiptr>(sizeBytes));
  return *this;
}

Program& Program::image(std::string_view name, const Texture& texture, ImageAccess access) {
  const unsigned place = binding(ShaderInput::Kind::kImage, name);
  assert(place < kMaxImages && isImageFormat(texture.format()));
  assert(access != ImageAccess::kReadWrite || texture.format() == TextureFormat::kR32f ||
         texture.format() == TextureFormat::kR32ui);
  const GLenum mode = access == ImageAccess::kRead    ? GL_READ_ONLY
                      : access == ImageAccess::kWrite ? GL_WRITE_ONLY
                                                      : GL_READ_WRITE;
  glBindImageTexture(place, texture.name(), 0, GL_FALSE, 0, mode,
                     glFormat(texture.format()).internal);
  return *this;
}

void Program::drawFullscreen(const RenderTarget& target) {
  if (!linked_->targets.empty()) {
    target.bindAsImages(linked_->targets);
    // Unlike drawing, stores to images wait for nothing that has read or written the target before.
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    dispatch({target.size().width, target.size().height},
             GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                 GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    return;
  }
  target.beginDiscarding();
  drawTriangle(nullptr);
}

void Program::drawArea(const RenderTarget& target, glm::ivec2 origin, hal::FrameSize size,
                       const Buffer* command) {
  assert(linked_->targets.empty());
  assert(command == nullptr || command->sizeBytes() >= kDrawCommandBytes);
  assert(origin.x >= 0 && origin.y >= 0 && origin.x + size.width <= target.size().width &&
         origin.y + size.height <= target.size().height);
  target.beginKeeping();
  glViewport(origin.x, origin.y, size.width, size.height);
  drawTriangle(command);
}

void Program::drawTriangle(const Buffer* command) {
  assert(isCurrent(linked_->handle));
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(linked_->emptyVertexArray.get());
  const PassTimer::Scope scope = measure();
  if (command == nullptr) {
    glDrawArrays(GL_TRIANGLES, 0, 3);
  } else {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, command->name());
    glDrawArraysIndirect(GL_TRIANGLES, nullptr);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  }
  glBindVertexArray(0);
}

void Program::dispatch(glm::ivec2 items, GLbitfield barriers) {
  assert(items.x > 0 && items.y > 0);
  assert(isCurrent(linked_->handle));
  dispatchGroups(groupsFor(items), barriers);
}

glm::ivec2 Program::groupsFor(glm::ivec2 items) const {
  return (items + linked_->groupSize - 1) / linked_->groupSize;
}

void Program::dispatchGroups(glm::ivec2 groups, GLbitfield barriers) {
  assert(glm::all(glm::lessThanEqual(groups, glm::ivec2(kMaxGroups))));
  const PassTimer::Scope scope = measure();
  glDispatchCompute(static_cast<GLuint>(groups.x), static_cast<GLuint>(groups.y), 1);
  glMemoryBarrier(barriers);
}

void Program::dispatchIndirect(const Buffer& commands, std::size_t offsetBytes,
                               GLbitfield barriers) {
  assert(isCurrent(linked_->handle));
  assert(offsetBytes % sizeof(GLuint) == 0 && offsetBytes + 12 <= commands.sizeBytes());
  const PassTimer::Scope scope = measure();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, commands.name());
  glDispatchComputeIndirect(static_cast<GLintptr>(offsetBytes));
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
  glMemoryBarrier(barriers);
}

void Program::dispatchListed(const Buffer& commands, std::size_t offsetBytes, glm::ivec2 mostGroups,
                             GLbitfield barriers) {
  if (linked_->listDispatch == ListDispatch::kAllGroups) {
    assert(isCurrent(linked_->handle));
    dispatchGroups(mostGroups, barriers);
  } else {
    dispatchIndirect(commands, offsetBytes, barriers);
  }
}

PassTimer::Scope Program::measure() const {
  PassTimer* const timer = timer_ == nullptr ? nullptr : *timer_;
  return timer == nullptr ? PassTimer::Scope(nullptr, 0) : timer->measureWithin(linked_->pass);
}

}  // namespace pleinair::gpu
