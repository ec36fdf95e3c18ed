#include "tests/embedded_gpu/record/gl_state.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/embedded_gpu/gl_names.h"

namespace pleinair::embedded_gpu {
namespace {

using nlohmann::json;

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

/// A texture as a shader or a target meets it.
struct BoundTexture {
  std::string format;  ///< empty: none is bound
  GLint width = 0;
  GLint height = 0;
};

std::string nameOfFormat(GLenum internal) {
  const FormatName* format = formatOf(internal);
  return format == nullptr ? fmt::format("0x{:04x}", internal) : std::string(format->name);
}

/// Of the texture that is bound to the active unit.
BoundTexture activeTexture(GLenum target) {
  if (target == GL_TEXTURE_EXTERNAL_OES) return {.format = "external"};
  GLint internal = 0;
  BoundTexture texture;
  glGetTexLevelParameteriv(target, 0, GL_TEXTURE_INTERNAL_FORMAT, &internal);
  glGetTexLevelParameteriv(target, 0, GL_TEXTURE_WIDTH, &texture.width);
  glGetTexLevelParameteriv(target, 0, GL_TEXTURE_HEIGHT, &texture.height);
  if (texture.width > 0) texture.format = nameOfFormat(static_cast<GLenum>(internal));
  return texture;
}

/// Of a texture by its name, which is bound to the active unit meanwhile.
BoundTexture textureOf(GLuint name) {
  const GLint before = integer(GL_TEXTURE_BINDING_2D);
  glBindTexture(GL_TEXTURE_2D, name);
  BoundTexture texture = activeTexture(GL_TEXTURE_2D);
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(before));
  return texture;
}

struct Uniform {
  std::string name;
  BindingKind kind{};
  GLint unit = 0;
};

/// The samplers and images of a program, each element of an array by itself.
std::vector<Uniform> boundUniforms(GLuint program) {
  std::vector<Uniform> uniforms;
  GLint count = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::array<GLchar, 128> text{};
    GLint elements = 0;
    GLenum type = 0;
    glGetActiveUniform(program, i, static_cast<GLsizei>(text.size()), nullptr, &elements, &type,
                       text.data());
    const BindingKind* kind = bindingKindOf(type);
    if (kind == nullptr) continue;
    const GLint location = glGetUniformLocation(program, text.data());
    std::string base = text.data();
    if (base.ends_with("[0]")) base.resize(base.size() - 3);
    for (GLint element = 0; element < elements; ++element) {
      Uniform uniform{.name = elements == 1 ? base : fmt::format("{}[{}]", base, element),
                      .kind = *kind};
      glGetUniformiv(program, location + element, &uniform.unit);
      uniforms.push_back(std::move(uniform));
    }
  }
  return uniforms;
}

BoundTexture boundTo(const Uniform& uniform) {
  if (uniform.kind.isImage) {
    GLint name = 0;
    glGetIntegeri_v(GL_IMAGE_BINDING_NAME, static_cast<GLuint>(uniform.unit), &name);
    return textureOf(static_cast<GLuint>(name));
  }
  const GLint active = integer(GL_ACTIVE_TEXTURE);
  glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + uniform.unit));
  BoundTexture texture = activeTexture(uniform.kind.target);
  glActiveTexture(static_cast<GLenum>(active));
  return texture;
}

GLint imageAccess(const Uniform& uniform) {
  GLint access = 0;
  glGetIntegeri_v(GL_IMAGE_BINDING_ACCESS, static_cast<GLuint>(uniform.unit), &access);
  return access;
}

/// The texture that an attachment of the bound target is, or nothing.
BoundTexture attached(GLenum attachment) {
  GLint type = GL_NONE;
  glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment,
                                        GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
  if (type != GL_TEXTURE) return {};
  GLint name = 0;
  glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment,
                                        GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &name);
  return textureOf(static_cast<GLuint>(name));
}

constexpr int kMaxTargets = 4;  // docs/gpu.md, rule 3

/// One entry for each output of a fragment shader; without a format where it writes to none.
std::vector<BoundTexture> boundTargets() {
  std::vector<BoundTexture> targets;
  for (int i = 0; i < kMaxTargets; ++i) {
    const auto attachment = static_cast<GLenum>(integer(static_cast<GLenum>(GL_DRAW_BUFFER0 + i)));
    targets.push_back(attachment == GL_NONE ? BoundTexture{} : attached(attachment));
  }
  while (!targets.empty() && targets.back().format.empty()) targets.pop_back();
  return targets;
}

json attributes() {
  json result = json::object();
  const GLint count = integer(GL_MAX_VERTEX_ATTRIBS);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const auto ask = [i](GLenum name) {
      GLint value = 0;
      glGetVertexAttribiv(i, name, &value);
      return value;
    };
    if (ask(GL_VERTEX_ATTRIB_ARRAY_ENABLED) == GL_FALSE) continue;
    result[fmt::format("{}", i)] = {
        ask(GL_VERTEX_ATTRIB_ARRAY_SIZE),       ask(GL_VERTEX_ATTRIB_ARRAY_TYPE),
        ask(GL_VERTEX_ATTRIB_ARRAY_NORMALIZED), ask(GL_VERTEX_ATTRIB_ARRAY_INTEGER),
        ask(GL_VERTEX_ATTRIB_ARRAY_STRIDE),     ask(GL_VERTEX_ATTRIB_ARRAY_DIVISOR)};
  }
  return result;
}

json sizeOf(const BoundTexture& texture) {
  const FormatName* format = formatOf(texture.format);
  return {texture.width, texture.height, format == nullptr ? 0 : format->bytesPerTexel};
}

}  // namespace

json stateOfDispatch(GLuint program) {
  json state = {{"textures", json::object()}, {"images", json::object()}};
  for (const Uniform& uniform : boundUniforms(program)) {
    const std::string format = boundTo(uniform).format;
    if (uniform.kind.isImage) {
      state["images"][uniform.name] = {format, imageAccess(uniform)};
    } else {
      state["textures"][uniform.name] = format;
    }
  }
  return state;
}

json stateOfDraw(GLuint program, GLenum mode, bool isIndexed) {
  json state = stateOfDispatch(program);
  state.erase("images");  // fragment and vertex shaders have none: docs/gpu.md, rules 2 and 3
  state["targets"] = json::array();
  for (const BoundTexture& target : boundTargets()) state["targets"].push_back(target.format);
  state["depth"] = attached(GL_DEPTH_ATTACHMENT).format;
  if (glIsEnabled(GL_BLEND) == GL_TRUE) {
    state["blend"] = {integer(GL_BLEND_SRC_RGB), integer(GL_BLEND_DST_RGB),
                      integer(GL_BLEND_SRC_ALPHA), integer(GL_BLEND_DST_ALPHA)};
  }
  if (glIsEnabled(GL_DEPTH_TEST) == GL_TRUE) {
    state["depth_test"] = {integer(GL_DEPTH_FUNC), integer(GL_DEPTH_WRITEMASK)};
  }
  state["cull"] = glIsEnabled(GL_CULL_FACE) == GL_TRUE;
  state["mode"] = mode;
  state["indexed"] = isIndexed;
  state["attributes"] = attributes();
  return state;
}

json sizesOfDispatch(GLuint program) {
  json sizes = {{"textures", json::object()}, {"images", json::object()}};
  for (const Uniform& uniform : boundUniforms(program)) {
    sizes[uniform.kind.isImage ? "images" : "textures"][uniform.name] = sizeOf(boundTo(uniform));
  }
  return sizes;
}

json sizesOfDraw(GLuint program) {
  json sizes = sizesOfDispatch(program);
  sizes.erase("images");
  sizes["targets"] = json::array();
  for (const BoundTexture& target : boundTargets()) sizes["targets"].push_back(sizeOf(target));
  sizes["depth"] = sizeOf(attached(GL_DEPTH_ATTACHMENT));
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  sizes["viewport"] = {viewport[2], viewport[3]};
  return sizes;
}

}  // namespace pleinair::embedded_gpu
