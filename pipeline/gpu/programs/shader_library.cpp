#include "pipeline/gpu/programs/shader_library.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <optional>
#include <regex>
#include <sstream>
#include <system_error>
#include <utility>

#include <EGL/egl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/error.h"
#include "pipeline/gpu/gpu_shaders.h"

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

/// "stroke.frag BUMPED CLIPPED".
std::string labelOf(std::string_view name, const ShaderDefines& defines) {
  std::string label(name);
  for (const ShaderDefine& define : defines) {
    if (define.value.empty()) label += " " + define.name;
  }
  return label;
}

/// Names a program: its shaders, and its defines with their values.
std::string keyOf(std::initializer_list<std::string_view> names, const ShaderDefines& defines) {
  std::string key = fmt::format("{}", fmt::join(names, " "));
  for (const ShaderDefine& define : defines)
    key += fmt::format(" {}={}", define.name, define.value);
  return key;
}

/// Adds the names that one more text of a program declares, each once.
void addInputs(std::string_view text, std::vector<ShaderInput>& inputs) {
  for (ShaderInput& input : declaredInputs(text)) {
    if (std::ranges::find(inputs, input.name, &ShaderInput::name) == inputs.end()) {
      inputs.push_back(std::move(input));
    }
  }
}

/// Gives the driver a program's name, for debuggers, captures and its messages (GL_KHR_debug):
/// "pipeline/gpu/shaders/fullscreen.vert pipeline/…/guide.frag", with the flags.
void labelForDriver(const ProgramHandle& program, std::string label) {
  const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  if (extensions == nullptr || std::strstr(extensions, "GL_KHR_debug") == nullptr) return;
  const auto give =
      reinterpret_cast<PFNGLOBJECTLABELKHRPROC>(eglGetProcAddress("glObjectLabelKHR"));
  if (give == nullptr) return;
  constexpr std::size_t kMostEverywhere = 255;  // characters
  label.resize(std::min(label.size(), kMostEverywhere));
  give(GL_PROGRAM_KHR, program.get(), static_cast<GLsizei>(label.size()), label.c_str());
}

Error shaderError(std::string_view name, std::string problem) {
  return Error{.kind = ErrorKind::kInvalidInput,
               .subject = fmt::format("shader {}", name),
               .problem = std::move(problem),
               .domain = ErrorDomain::kGl};
}

/// The file's text; nothing where there is no such file.
std::optional<std::string> overridingText(const std::filesystem::path& path) {
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (type == std::filesystem::file_type::not_found) return std::nullopt;
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file && file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  if (!file.is_open() || file.bad() || type != std::filesystem::file_type::regular) {
    const int cause = type == std::filesystem::file_type::directory ? EISDIR
                      : error                                       ? error.value()
                                                                    : errno;
    throw hal::Failure(hal::errnoError(path.string(), "cannot read this shader", cause,
                                       "fix the file, or remove it: there is a built-in one"));
  }
  return text.str();
}

}  // namespace

std::string nameLinesOfLog(const std::string& log, std::span<const SourceLine> lines) {
  std::string result;
  std::istringstream input(log);
  const std::regex place(R"(^[0-9]+(?::([0-9]+)|\(([0-9]+)\)))");
  for (std::string text; std::getline(input, text);) {
    std::smatch match;
    if (std::regex_search(text, match, place)) {
      const std::size_t number = std::stoul(match[1].matched ? match[1] : match[2]);
      if (number >= 1 && number <= lines.size()) {
        const SourceLine& source = lines[number - 1];
        text = fmt::format("{}:{}{}", source.file, source.line, match.suffix().str());
      }
    }
    result += (result.empty() ? "" : "\n") + text;
  }
  return result;
}

ShaderLibrary::ShaderLibrary(std::filesystem::path overrideDirectory)
    : overrideDirectory_(std::move(overrideDirectory)) {
  std::error_code ignored;
  if (!overrideDirectory_.empty() && !std::filesystem::is_directory(overrideDirectory_, ignored)) {
    throw hal::Failure(Error{.kind = ErrorKind::kNotFound,
                             .subject = overrideDirectory_.string(),
                             .problem = "no such directory of shaders",
                             .remedy = "name a copy of the source tree"});
  }
  add(gpuShaders());
}

void ShaderLibrary::add(std::span<const EmbeddedShader> shaders) {
  shaders_.insert(shaders_.end(), shaders.begin(), shaders.end());
}

std::string ShaderLibrary::text(std::string_view name, std::string_view includer) const {
  if (!overrideDirectory_.empty()) {
    if (auto override = overridingText(overrideDirectory_ / name)) return *std::move(override);
  }
  const auto found = std::ranges::find(shaders_, name, &EmbeddedShader::name);
  if (found == shaders_.end()) {
    std::vector<std::string_view> known;
    for (const EmbeddedShader& shader : shaders_) known.push_back(shader.name);
    Error error = shaderError(name, includer.empty()
                                        ? "no such shader"
                                        : fmt::format("no such shader, included by {}", includer));
    error.kind = ErrorKind::kNotFound;
    error.remedy = fmt::format("there are {}", fmt::join(known, ", "));
    throw hal::Failure(std::move(error));
  }
  return std::string(found->text);
}

void ShaderLibrary::expandInto(std::string_view name, std::string_view includer,
                               Expansion& output) const {
  output.files.emplace_back(name);
  std::istringstream lines(text(name, includer));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const bool isRead = output.conditions.reads(line);
    const std::string_view included = includedName(line);
    if (included.empty()) {
      output.text += line + "\n";
      output.lines.push_back({std::string(name), number});
    } else if (isRead && std::ranges::find(output.files, included) == output.files.end()) {
      expandInto(included, name, output);
    }
  }
}

ShaderLibrary::Expansion ShaderLibrary::expand(std::string_view name,
                                               const ShaderDefines& defines) const {
  Expansion result{.text = std::string(kHeader)};
  for (const ShaderDefine& define : defines) {
    const std::string line = fmt::format("#define {} {}", define.name, define.value);
    (void)result.conditions.reads(line);
    result.text += line + "\n";
  }
  for (int line = 1; line <= std::ranges::count(result.text, '\n'); ++line) {
    result.lines.push_back({"shader library's header", line});
  }
  expandInto(name, {}, result);
  return result;
}

std::string ShaderLibrary::expanded(std::string_view name, const ShaderDefines& defines) const {
  return expand(name, defines).text;
}

ShaderHandle ShaderLibrary::compile(GLenum stage, std::string_view name,
                                    const Expansion& source) const {
  ShaderHandle shader(glCreateShader(stage));
  const GLchar* pointer = source.text.c_str();
  glShaderSource(shader.get(), 1, &pointer, nullptr);
  glCompileShader(shader.get());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_FALSE) {
    std::array<GLchar, 4096> log{};
    glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw hal::Failure(
        shaderError(name, "does not compile: " + nameLinesOfLog(log.data(), source.lines)));
  }
  return shader;
}

Program ShaderLibrary::link(ProgramKind kind, std::span<const ShaderHandle> shaders,
                            std::string label, std::span<const Expansion* const> sources,
                            const PassTargets& targets) const {
  throwIfCancelled();
  ProgramHandle program = ProgramHandle::make();
  for (const ShaderHandle& shader : shaders) glAttachShader(program.get(), shader.get());
  glLinkProgram(program.get());
  for (const ShaderHandle& shader : shaders) glDetachShader(program.get(), shader.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) {
    std::array<GLchar, 4096> log{};
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw hal::Failure(shaderError(label, fmt::format("does not link: {}", log.data())));
  }
  const std::string vertices = sources.size() > 1 ? sources.front()->files.front() + " " : "";
  labelForDriver(program, vertices + label);
  std::vector<ShaderInput> inputs;
  for (const Expansion* source : sources) addInputs(source->text, inputs);
  ++compiled_;
  return {std::move(program), kind, std::move(label), std::move(inputs), timer_, targets,
          listDispatch_};
}

void ShaderLibrary::throwIfCancelled() const {
  if (!isCancelled_ || !isCancelled_()) return;
  throw hal::Failure({.kind = hal::ErrorKind::kCancelled,
                      .subject = "shaders",
                      .problem = "their compilation was cancelled",
                      .remedy = {}});
}

/// The program of this key, made where there is none yet.
Program ShaderLibrary::made(const std::string& key, const std::function<Program()>& make) const {
  const auto known = programs_.find(key);
  return known != programs_.end() ? known->second : programs_.emplace(key, make()).first->second;
}

Program ShaderLibrary::fragmentPass(std::string_view fragmentName, const ShaderDefines& defines,
                                    const PassTargets& targets) const {
  return passForm_ == PassForm::kCompute && !targets.empty()
             ? computePass(fragmentName, defines, targets)
             : draw(kFullscreenVertex, fragmentName, defines);
}

Program ShaderLibrary::computePass(std::string_view fragmentName, const ShaderDefines& defines,
                                   const PassTargets& targets) const {
  std::string key = keyOf({fragmentName}, defines) + " as compute for";
  for (const TextureFormat target : targets) key += fmt::format(" {}", static_cast<int>(target));
  return made(key, [&] {
    Expansion source = expand(fragmentName, defines);
    source.text = computeFormOf(source.text, targets);
    source.lines.insert(source.lines.begin() + 1, kComputeFormLines, {"compute form of a pass", 1});
    const std::array<ShaderHandle, 1> shaders{compile(GL_COMPUTE_SHADER, fragmentName, source)};
    return link(ProgramKind::kCompute, shaders, labelOf(fragmentName, defines), std::array{&source},
                targets);
  });
}

Program ShaderLibrary::compute(std::string_view computeName, const ShaderDefines& defines) const {
  return made(keyOf({computeName}, defines), [&] {
    const Expansion source = expand(computeName, defines);
    const std::array<ShaderHandle, 1> shaders{compile(GL_COMPUTE_SHADER, computeName, source)};
    return link(ProgramKind::kCompute, shaders, labelOf(computeName, defines), std::array{&source});
  });
}

Program ShaderLibrary::draw(std::string_view vertexName, std::string_view fragmentName,
                            const ShaderDefines& defines) const {
  return made(keyOf({vertexName, fragmentName}, defines), [&] {
    const Expansion vertices = expand(vertexName, defines);
    const Expansion fragments = expand(fragmentName, defines);
    const std::array<ShaderHandle, 2> shaders{compile(GL_VERTEX_SHADER, vertexName, vertices),
                                              compile(GL_FRAGMENT_SHADER, fragmentName, fragments)};
    return link(ProgramKind::kDraw, shaders, labelOf(fragmentName, defines),
                std::array{&vertices, &fragments});
  });
}

}  // namespace pleinair::gpu
