#include "tests/embedded_gpu/replay/device_limits.h"

#include <array>
#include <string_view>
#include <utility>

#include "pipeline/gpu/gl.h"

namespace pleinair::embedded_gpu {
namespace {

constexpr std::array<std::pair<const char*, GLenum>, 20> kLimits{{
    {"MAX_TEXTURE_SIZE", GL_MAX_TEXTURE_SIZE},
    {"MAX_DRAW_BUFFERS", GL_MAX_DRAW_BUFFERS},
    {"MAX_TEXTURE_IMAGE_UNITS", GL_MAX_TEXTURE_IMAGE_UNITS},
    {"MAX_VERTEX_TEXTURE_IMAGE_UNITS", GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS},
    {"MAX_COMPUTE_TEXTURE_IMAGE_UNITS", GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS},
    {"MAX_VERTEX_ATTRIBS", GL_MAX_VERTEX_ATTRIBS},
    {"MAX_VARYING_VECTORS", GL_MAX_VARYING_VECTORS},
    {"MAX_UNIFORM_BLOCK_SIZE", GL_MAX_UNIFORM_BLOCK_SIZE},
    {"UNIFORM_BUFFER_OFFSET_ALIGNMENT", GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT},
    {"MAX_FRAGMENT_UNIFORM_BLOCKS", GL_MAX_FRAGMENT_UNIFORM_BLOCKS},
    {"MAX_COMPUTE_UNIFORM_BLOCKS", GL_MAX_COMPUTE_UNIFORM_BLOCKS},
    {"MAX_VERTEX_SHADER_STORAGE_BLOCKS", GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS},
    {"MAX_FRAGMENT_SHADER_STORAGE_BLOCKS", GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS},
    {"MAX_COMPUTE_SHADER_STORAGE_BLOCKS", GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS},
    {"SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT", GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT},
    {"MAX_VERTEX_IMAGE_UNIFORMS", GL_MAX_VERTEX_IMAGE_UNIFORMS},
    {"MAX_FRAGMENT_IMAGE_UNIFORMS", GL_MAX_FRAGMENT_IMAGE_UNIFORMS},
    {"MAX_COMPUTE_IMAGE_UNIFORMS", GL_MAX_COMPUTE_IMAGE_UNIFORMS},
    {"MAX_COMPUTE_WORK_GROUP_INVOCATIONS", GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS},
    {"MAX_COMPUTE_SHARED_MEMORY_SIZE", GL_MAX_COMPUTE_SHARED_MEMORY_SIZE},
}};

constexpr std::array<std::string_view, 9> kExtensions{"GL_EXT_color_buffer_float",
                                                      "GL_EXT_color_buffer_half_float",
                                                      "GL_EXT_float_blend",
                                                      "GL_OES_texture_float_linear",
                                                      "GL_EXT_disjoint_timer_query",
                                                      "GL_KHR_debug",
                                                      "GL_KHR_robustness",
                                                      "GL_EXT_robustness",
                                                      "GL_OES_EGL_image_external_essl3"};

const char* text(GLenum name) {
  return reinterpret_cast<const char*>(glGetString(name));
}

}  // namespace

nlohmann::json deviceLimits() {
  nlohmann::json limits = nlohmann::json::object();
  for (const auto& [name, value] : kLimits) {
    GLint limit = -1;
    glGetIntegerv(value, &limit);
    limits[name] = limit;
  }
  nlohmann::json offered = nlohmann::json::array();
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i));
    for (const std::string_view known : kExtensions) {
      if (known == name) offered.push_back(known);
    }
  }
  return {{"renderer", text(GL_RENDERER)},
          {"version", text(GL_VERSION)},
          {"limits", limits},
          {"extensions", offered}};
}

}  // namespace pleinair::embedded_gpu
