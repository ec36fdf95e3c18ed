// Compiles recorded programs with the OpenGL ES driver in reach and uses each in its recorded
// states, for what the driver's compiler says of them. Meant to run over a driver of a GPU that is
// not there (README.md).
//
//     program_replay TREE SECONDS < RECORDS
//     program_replay --sources TREE < RECORDS    prints the texts that a compiler would get
//
// Shaders are read from TREE. RECORDS are lines of JSON, as the recorder writes them. Prints lines
// of JSON: first the context's limits, then before each record {"begins": i} and after it
// {"ends": i, "problem": …, "cpu_ms": …, "messages": […]}. A record that takes longer than SECONDS
// ends the process by SIGALRM.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "tests/embedded_gpu/replay/device_limits.h"
#include "tests/embedded_gpu/replay/replayed_state.h"

namespace pleinair::embedded_gpu {
namespace {

using nlohmann::json;

/// Processor time of all threads of this process so far.
double processorMilliseconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1e3 * static_cast<double>(usage.ru_utime.tv_sec) +
         1e-3 * static_cast<double>(usage.ru_utime.tv_usec);
}

void GL_APIENTRY keepMessage(GLenum /*source*/, GLenum /*type*/, GLuint /*id*/, GLenum /*severity*/,
                             GLsizei /*length*/, const GLchar* message, const void* messages) {
  auto* kept =
      const_cast<std::vector<std::string>*>(static_cast<const std::vector<std::string>*>(messages));
  kept->emplace_back(message);
}

/// Drivers tell what their compilers made in debug messages of the lowest severity.
void listen(std::vector<std::string>& messages) {
  glEnable(GL_DEBUG_OUTPUT_KHR);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS_KHR);
  const auto callback = reinterpret_cast<PFNGLDEBUGMESSAGECALLBACKKHRPROC>(
      eglGetProcAddress("glDebugMessageCallbackKHR"));
  const auto control = reinterpret_cast<PFNGLDEBUGMESSAGECONTROLKHRPROC>(
      eglGetProcAddress("glDebugMessageControlKHR"));
  callback(keepMessage, &messages);
  control(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
}

gpu::ShaderDefines definesOf(const json& lines) {
  gpu::ShaderDefines defines;
  for (const std::string line : lines) {
    const std::size_t space = std::min(line.find(' '), line.size());
    defines.push_back({line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
  }
  return defines;
}

/// The shaders of a program's label, without its flags.
std::vector<std::string> shadersOf(const std::string& label) {
  std::istringstream words(label);
  std::vector<std::string> shaders;
  for (std::string word; words >> word;) {
    if (word.find('/') != std::string::npos) shaders.push_back(word);
  }
  return shaders;
}

gpu::Program programOf(const gpu::ShaderLibrary& library, const json& record) {
  const std::vector<std::string> shaders = shadersOf(record.at("program"));
  const gpu::ShaderDefines defines = definesOf(record.at("defines"));
  return shaders.size() == 1 ? library.compute(shaders.at(0), defines)
                             : library.draw(shaders.at(0), shaders.at(1), defines);
}

void print(const json& line) {
  std::cout << line.dump() << std::endl;  // flushed: the driver may die of what comes next
}

int replay(const std::string& tree, unsigned patienceSeconds) {
  const gpu::EglContext context;
  print(deviceLimits());
  std::vector<std::string> messages;
  listen(messages);
  const gpu::ShaderLibrary library(tree);
  ReplayedState state;
  int number = 0;
  for (std::string line; std::getline(std::cin, line); ++number) {
    print({{"begins", number}});
    messages.clear();
    alarm(patienceSeconds);
    const double began = processorMilliseconds();
    std::string problem;
    try {
      const json record = json::parse(line);
      gpu::Program program = programOf(library, record);
      state.use(program, record.at("state"));
    } catch (const std::exception& error) {
      problem = error.what();
    }
    print({{"ends", number},
           {"problem", problem},
           {"cpu_ms", processorMilliseconds() - began},
           {"messages", messages}});
  }
  return 0;
}

int printSources(const std::string& tree) {
  const gpu::ShaderLibrary library(tree);
  for (std::string line; std::getline(std::cin, line);) {
    const json record = json::parse(line);
    json sources = json::array();
    for (const std::string& shader : shadersOf(record.at("program"))) {
      sources.push_back(library.expanded(shader, definesOf(record.at("defines"))));
    }
    print({{"sources", sources}});
  }
  return 0;
}

}  // namespace
}  // namespace pleinair::embedded_gpu

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: program_replay [--sources] TREE [SECONDS] < RECORDS\n", stderr);
    return 2;
  }
  try {
    if (std::string_view(arguments[1]) == "--sources") {
      return pleinair::embedded_gpu::printSources(arguments[2]);
    }
    const unsigned long patience = std::stoul(arguments[2]);
    return pleinair::embedded_gpu::replay(arguments[1], static_cast<unsigned>(patience));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "program_replay: %s\n", error.what());
    return 1;
  }
}
