#include "pipeline/gpu/shader_library.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "hal/error.h"

namespace pleinair::gpu {
namespace {

using hal::Error;
using hal::ErrorDomain;
using hal::ErrorKind;

constexpr std::string_view kFullscreenVertex = "pipeline/gpu/shaders/fullscreen.vert";

constexpr std::string_view kHeader =
    "#version 310 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n"
    "precision highp usampler2D;\n"
    "precision highp isampler2D;\n"
    "precision highp image2D;\n"
    "precision highp uimage2D;\n";

/// The name in `#include "name"`, or nothing.
std::string_view includedName(std::string_view line) {
  constexpr std::string_view kDirective = "#include \"";
  if (!line.starts_with(kDirective)) return {};
  line.remove_prefix(kDirective.size());
  return line.substr(0, line.find('"'));
}

/// A compiler's log with its file numbers ("1:23") replaced by file names.
std::string nameFiles(const std::string& log, std::span<const std::string> files) {
  std::string result;
  std::istringstream lines(log);
  static const std::regex kPlace("^([0-9]+):([0-9]+)");
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kPlace)) {
      const auto file = static_cast<std::size_t>(std::stoul(match[1]));
      if (file < files.size()) {
        line = fmt::format("{}:{}{}", files[file], match[2].str(), match.suffix().str());
      }
    }
    result += (result.empty() ? "" : "\n") + line;
  }
  return result;
}

Error shaderError(std::string_view name, std::string problem) {
  return Error{.kind = ErrorKind::kInvalidInput,
               .subject = fmt::format("shader {}", name),
               .problem = std::move(problem),
               .domain = ErrorDomain::kGl};
}

}  // namespace

ShaderLibrary::ShaderLibrary(std::filesystem::path overrideDirectory)
    : overrideDirectory_(std::move(overrideDirectory)) {
  add(gpuShaders());
}

void ShaderLibrary::add(std::span<const EmbeddedShader> shaders) {
  shaders_.insert(shaders_.end(), shaders.begin(), shaders.end());
}

std::string ShaderLibrary::text(std::string_view name) const {
  if (!overrideDirectory_.empty()) {
    std::ifstream file(overrideDirectory_ / name, std::ios::binary);
    if (file) return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  const auto found = std::ranges::find(shaders_, name, &EmbeddedShader::name);
  if (found == shaders_.end()) {
    throw hal::StartupError(shaderError(name, "no such shader"));
  }
  return std::string(found->text);
}

void ShaderLibrary::expandInto(std::string_view name, std::vector<std::string>& files,
                               std::string& output) const {
  const std::size_t file = files.size();
  files.emplace_back(name);
  output += fmt::format("#line 1 {}\n", file);
  std::istringstream lines(text(name));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string_view included = includedName(line);
    if (included.empty()) {
      output += line + "\n";
      continue;
    }
    if (std::ranges::find(files, included) == files.end()) expandInto(included, files, output);
    output += fmt::format("#line {} {}\n", number + 1, file);
  }
}

std::string ShaderLibrary::expanded(std::string_view name) const {
  std::string output(kHeader);
  std::vector<std::string> files;
  expandInto(name, files, output);
  return output;
}

ShaderHandle ShaderLibrary::compile(GLenum stage, std::string_view name) const {
  std::string source(kHeader);
  std::vector<std::string> files;
  expandInto(name, files, source);
  ShaderHandle shader(glCreateShader(stage));
  const GLchar* pointer = source.c_str();
  glShaderSource(shader.get(), 1, &pointer, nullptr);
  glCompileShader(shader.get());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_FALSE) {
    std::array<GLchar, 4096> log{};
    glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw hal::StartupError(shaderError(name, "does not compile: " + nameFiles(log.data(), files)));
  }
  return shader;
}

Program ShaderLibrary::link(std::span<const ShaderHandle> shaders, std::string_view label) const {
  ProgramHandle program = ProgramHandle::make();
  for (const ShaderHandle& shader : shaders) glAttachShader(program.get(), shader.get());
  glLinkProgram(program.get());
  for (const ShaderHandle& shader : shaders) glDetachShader(program.get(), shader.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) {
    std::array<GLchar, 4096> log{};
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw hal::StartupError(shaderError(label, fmt::format("does not link: {}", log.data())));
  }
  return Program(std::move(program), std::string(label));
}

Program ShaderLibrary::fragmentPass(std::string_view fragmentName) const {
  return draw(kFullscreenVertex, fragmentName);
}

Program ShaderLibrary::compute(std::string_view computeName) const {
  const std::array<ShaderHandle, 1> shaders{compile(GL_COMPUTE_SHADER, computeName)};
  return link(shaders, computeName);
}

Program ShaderLibrary::draw(std::string_view vertexName, std::string_view fragmentName) const {
  const std::array<ShaderHandle, 2> shaders{compile(GL_VERTEX_SHADER, vertexName),
                                            compile(GL_FRAGMENT_SHADER, fragmentName)};
  return link(shaders, fragmentName);
}

}  // namespace pleinair::gpu
