#include "pipeline/gpu/programs/pass_form.h"

#include <cstddef>
#include <cstring>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/programs/shader_interface.h"

namespace pleinair::gpu {
namespace {

/// GLSL's name of an image's format; empty for formats that are no images'.
std::string_view imageFormatOf(TextureFormat format) {
  switch (format) {
    case TextureFormat::kR8:
      return "r8";
    case TextureFormat::kRg8:
      return "rg8";
    case TextureFormat::kRgba8:
      return "rgba8";
    case TextureFormat::kRgba16f:
      return "rgba16f";
    case TextureFormat::kRg16f:
      return "rg16f";
    case TextureFormat::kR32f:
      return "r32f";
    case TextureFormat::kRgba32f:
      return "rgba32f";
    case TextureFormat::kR32ui:
      return "r32ui";
    case TextureFormat::kRg32ui:
      return "rg32ui";
    case TextureFormat::kRgb8:
    case TextureFormat::kSrgba8:
    case TextureFormat::kDepth24:
      return "";
  }
  return "";
}

bool isUnsigned(TextureFormat format) {
  return format == TextureFormat::kR32ui || format == TextureFormat::kRg32ui;
}

/// An output as the four components that imageStore() takes.
std::string asVec4(const std::string& type, const std::string& name) {
  if (type == "float") return fmt::format("vec4({}, 0.0, 0.0, 1.0)", name);
  if (type == "vec2") return fmt::format("vec4({}, 0.0, 1.0)", name);
  if (type == "vec3") return fmt::format("vec4({}, 1.0)", name);
  if (type == "uint") return fmt::format("uvec4({}, 0u, 0u, 1u)", name);
  if (type == "uvec2") return fmt::format("uvec4({}, 0u, 1u)", name);
  return name;
}

[[noreturn]] void refuse(const std::string& problem) {
  throw hal::Failure({.kind = hal::ErrorKind::kInternal,
                      .subject = "a full-screen pass as a compute shader",
                      .problem = problem,
                      .remedy = {}});
}

}  // namespace

PassForm fasterPassForm(const ContextInfo& context) {
  return context.renderer.starts_with("NVIDIA ") && hasComputeForm() ? PassForm::kCompute
                                                                     : PassForm::kFragment;
}

bool hasComputeForm() {
  const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  return extensions != nullptr && std::strstr(extensions, "GL_NV_image_formats") != nullptr;
}

std::string computeFormOf(std::string_view fragment, std::span<const TextureFormat> targets) {
  static const std::regex kOutput(
      R"(^layout\(location = ([0-9])\) out (?:highp |mediump |lowp )?(\w+) (\w+);)");
  static const std::regex kPlace(R"(\bgl_FragCoord\b)");
  static const std::regex kMain(R"(\bvoid main\(\))");
  static const std::regex kFragmentOnly(
      R"(\b(?:dFdx|dFdy|fwidth|discard|gl_FrontFacing|gl_PointCoord|gl_FragDepth)\b)"
      R"(|^\s*(?:layout\([^)]*\)\s*)?(?:(?:flat|smooth|centroid|highp|mediump|lowp)\s+)*in\s)");
  std::string declared;
  std::string stores;
  std::set<std::size_t> outputs;
  bool hasMain = false;
  std::string body;
  std::istringstream lines(activeLines(fragment));
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kOutput)) {
      const std::size_t location = std::stoul(match[1]);
      if (location >= targets.size()) refuse("it writes to more targets than it was made for");
      const std::string_view format = imageFormatOf(targets[location]);
      if (format.empty()) refuse("a target is of a format that no image has");
      const std::string type = match[2];
      const std::string name = match[3];
      declared +=
          fmt::format("layout({}, binding = {}) writeonly uniform highp {} passTarget{}; ", format,
                      location, isUnsigned(targets[location]) ? "uimage2D" : "image2D", location);
      stores +=
          fmt::format("  imageStore(passTarget{}, passPixel, {});\n", location, asVec4(type, name));
      line = type + " " + name + ";" + match.suffix().str();
      if (!outputs.insert(location).second) refuse("two outputs have one location");
    }
    const std::string code = line.substr(0, line.find("//"));
    if (std::regex_search(code, match, kFragmentOnly)) {
      refuse(fmt::format("it has \"{}\"", match.str()));
    }
    line = std::regex_replace(line, kPlace, "passFragCoord");
    hasMain = hasMain || std::regex_search(line, kMain);
    line = std::regex_replace(line, kMain, "void runPass()");
    body += line + "\n";
  }
  if (outputs.size() != targets.size()) refuse("it writes to fewer targets than it was made for");
  if (!hasMain) refuse("it has no \"void main()\"");
  // Behind the version, which must come first.
  const std::size_t version = body.find('\n') + 1;
  body.insert(version,
              "#extension GL_NV_image_formats : require\n"
              "layout(local_size_x = 8, local_size_y = 8) in; highp vec4 passFragCoord; " +
                  declared + "\n");
  return body +
         "void main() {\n"
         "  ivec2 passPixel = ivec2(gl_GlobalInvocationID.xy);\n"
         "  if (any(greaterThanEqual(passPixel, imageSize(passTarget0)))) return;\n"
         "  passFragCoord = vec4(vec2(passPixel) + 0.5, 0.0, 1.0);\n"
         "  runPass();\n" +
         stores + "}\n";
}

}  // namespace pleinair::gpu
