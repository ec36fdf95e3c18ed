// What every test runs under, set before main().
#include <cstdlib>

namespace {

// Blending into 32-bit floats becomes a GL error, as on the targets (GPU rules, rule 5).
[[maybe_unused]] const int kFloatBlendForbidden =
    setenv("MESA_EXTENSION_OVERRIDE", "-GL_EXT_float_blend", 0);

}  // namespace

// The sanitizers' run-time libraries call these. Mesa keeps tables until exit, and its rasteriser's
// threads are not built with the thread sanitizer.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgallium\nleak:swrast_dri.so\nleak:libLLVM\nleak:libEGL\n";
}
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:swrast_dri.so\nrace:swrast_dri.so\nrace:libLLVM\n";
}
