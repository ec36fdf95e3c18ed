// Records the programs that a process draws and dispatches with, and the states that they meet.
// Preloaded into an unchanged program (LD_PRELOAD), it stands before libGLESv2's draws, dispatches
// and shader sources; at the process's end it writes GL_RECORDER_FILE (README.md: "Records").
// Any thread, one at a time: GL is asked on the thread of the call.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <dlfcn.h>
#include <nlohmann/json.hpp>

#include "pipeline/gpu/gl.h"
#include "tests/embedded_gpu/record/gl_state.h"

namespace pleinair::embedded_gpu {
namespace {

using nlohmann::json;

/// libGLESv2's own function.
template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// "pipeline/…/guide.frag FLAG", as the shader library labels its programs; empty: no label.
std::string labelOf(GLuint program) {
  static const auto getLabel =
      reinterpret_cast<PFNGLGETOBJECTLABELKHRPROC>(eglGetProcAddress("glGetObjectLabelKHR"));
  constexpr GLsizei kLongest = 256;
  std::string label(kLongest, '\0');
  GLsizei length = 0;
  getLabel(GL_PROGRAM_KHR, program, kLongest, &length, label.data());
  label.resize(static_cast<std::size_t>(length));
  return label;
}

/// The `#define` lines that the shader library puts between the precisions and the file.
std::vector<std::string> definesOf(std::string_view text) {
  std::vector<std::string> defines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (line.starts_with("#define ")) {
      defines.emplace_back(line.substr(std::string_view("#define ").size()));
    } else if (!line.starts_with("#version") && !line.starts_with("precision ")) {
      break;
    }
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return defines;
}

class Recorder {
 public:
  static Recorder& instance() {
    static Recorder recorder;
    return recorder;
  }

  void shaderSource(GLuint shader, std::string_view text) {
    const std::scoped_lock lock(mutex_);
    defines_[shader] = definesOf(text);
  }

  void attach(GLuint program, GLuint shader) {
    const std::scoped_lock lock(mutex_);
    definesOfProgram_[program] = defines_[shader];
  }

  /// One more run of the current program; `work` says how much of it (README.md).
  void run(GLuint program, const json& state, const json& work) {
    const std::scoped_lock lock(mutex_);
    const json entry = {{"program", labelOf(program)},
                        {"defines", definesOfProgram_[program]},
                        {"state", state},
                        {"work", work}};
    ++counts_[entry.dump()];
  }

 private:
  Recorder() = default;
  ~Recorder() {
    const char* path = std::getenv("GL_RECORDER_FILE");  // NOLINT(concurrency-mt-unsafe)
    std::FILE* file = path == nullptr || counts_.empty() ? nullptr : std::fopen(path, "w");
    if (file == nullptr) return;
    for (const auto& [entry, count] : counts_) {
      json line = json::parse(entry);
      line["count"] = count;
      std::fputs((line.dump() + "\n").c_str(), file);
    }
    std::fclose(file);
  }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  std::mutex mutex_;
  std::map<GLuint, std::vector<std::string>> defines_;           // by shader
  std::map<GLuint, std::vector<std::string>> definesOfProgram_;  // by program
  std::map<std::string, long> counts_;
};

GLuint currentProgram() {
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  return static_cast<GLuint>(program);
}

void recordDraw(GLenum mode, bool isIndexed, GLsizei vertices, GLuint instances) {
  const GLuint program = currentProgram();
  json work = sizesOfDraw(program);
  work["vertices"] = vertices;
  work["instances"] = instances;
  Recorder::instance().run(program, stateOfDraw(program, mode, isIndexed), work);
}

/// `isListed`: the groups were counted on the GPU.
void recordDispatch(std::array<GLuint, 3> groups, bool isListed) {
  const GLuint program = currentProgram();
  json work = sizesOfDispatch(program);
  work["groups"] = groups;
  if (isListed) work["listed"] = true;
  std::array<GLint, 3> size{};
  glGetProgramiv(program, GL_COMPUTE_WORK_GROUP_SIZE, size.data());
  work["group_size"] = size;
  Recorder::instance().run(program, stateOfDispatch(program), work);
}

/// The words of the command that the buffer bound to `target` has at an offset.
template <std::size_t count>
std::array<GLuint, count> indirectCommand(GLenum target, GLintptr offset) {
  std::array<GLuint, count> command{};
  const void* mapped = glMapBufferRange(target, offset, sizeof(command), GL_MAP_READ_BIT);
  if (mapped == nullptr) return command;
  std::copy_n(static_cast<const GLuint*>(mapped), count, command.begin());
  glUnmapBuffer(target);
  return command;
}

}  // namespace
}  // namespace pleinair::embedded_gpu

namespace recording = pleinair::embedded_gpu;

extern "C" {

void GL_APIENTRY glShaderSource(GLuint shader, GLsizei count, const GLchar* const* texts,
                                const GLint* lengths) {
  if (count == 1 && lengths == nullptr) {
    recording::Recorder::instance().shaderSource(shader, texts[0]);
  }
  static const auto real = recording::next<decltype(&glShaderSource)>("glShaderSource");
  real(shader, count, texts, lengths);
}

void GL_APIENTRY glAttachShader(GLuint program, GLuint shader) {
  recording::Recorder::instance().attach(program, shader);
  static const auto real = recording::next<decltype(&glAttachShader)>("glAttachShader");
  real(program, shader);
}

void GL_APIENTRY glDrawArrays(GLenum mode, GLint first, GLsizei count) {
  recording::recordDraw(mode, false, count, 1);
  static const auto real = recording::next<decltype(&glDrawArrays)>("glDrawArrays");
  real(mode, first, count);
}

void GL_APIENTRY glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
  recording::recordDraw(mode, true, count, 1);
  static const auto real = recording::next<decltype(&glDrawElements)>("glDrawElements");
  real(mode, count, type, indices);
}

void GL_APIENTRY glDrawArraysIndirect(GLenum mode, const void* indirect) {
  const auto command =
      recording::indirectCommand<4>(GL_DRAW_INDIRECT_BUFFER, reinterpret_cast<GLintptr>(indirect));
  recording::recordDraw(mode, false, static_cast<GLsizei>(command[0]), command[1]);
  static const auto real = recording::next<decltype(&glDrawArraysIndirect)>("glDrawArraysIndirect");
  real(mode, indirect);
}

void GL_APIENTRY glDispatchCompute(GLuint x, GLuint y, GLuint z) {
  recording::recordDispatch({x, y, z}, false);
  static const auto real = recording::next<decltype(&glDispatchCompute)>("glDispatchCompute");
  real(x, y, z);
}

void GL_APIENTRY glDispatchComputeIndirect(GLintptr indirect) {
  recording::recordDispatch(recording::indirectCommand<3>(GL_DISPATCH_INDIRECT_BUFFER, indirect),
                            true);
  static const auto real =
      recording::next<decltype(&glDispatchComputeIndirect)>("glDispatchComputeIndirect");
  real(indirect);
}
}
