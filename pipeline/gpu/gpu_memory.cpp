#include "pipeline/gpu/gpu_memory.h"

#include <fmt/format.h>

#include "hal/error.h"
#include "pipeline/gpu/gl.h"

namespace pleinair::gpu {

void checkMemory(std::string_view what) {
  // Other errors are broken contracts of ours, which builds with assertions report; a lost context
  // may repeat its error for ever.
  constexpr int kErrorFlags = 8;
  for (int i = 0; i < kErrorFlags; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    if (error == GL_OUT_OF_MEMORY) throwOutOfMemory(what);
  }
}

void throwOutOfMemory(std::string_view what) {
  throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                .subject = "GPU",
                                .problem = fmt::format("the GPU has no memory for {}", what),
                                .remedy = "paint smaller, or end other programs that use the GPU",
                                .domain = hal::ErrorDomain::kGl,
                                .code = GL_OUT_OF_MEMORY});
}

}  // namespace pleinair::gpu
