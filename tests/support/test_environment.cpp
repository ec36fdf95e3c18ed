// The environment of every test, set before main().
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

namespace {

// Makes blending into 32-bit floats a GL error, as on the targets (docs/gpu.md, rule 5).
[[maybe_unused]] const int kFloatBlendForbidden =
    setenv("MESA_EXTENSION_OVERRIDE", "-GL_EXT_float_blend", 0);

// Compiling shaders to machine code takes most of the time of a small GPU test (0.3 s per program
// the first time, 10 ms from the cache). The cache lies in the build folder and is removed with it.
[[maybe_unused]] const int kShaderCacheDirectory =
    setenv("MESA_SHADER_CACHE_DIR", PLEINAIR_BUILD_DIR, 0);

/// Tells CTest that a whole suite was skipped (cmake/AddSuites.cmake).
class SkipReporter : public testing::EmptyTestEventListener {
 public:
  void OnTestProgramEnd(const testing::UnitTest& tests) override {
    if (tests.skipped_test_count() > 0 && tests.skipped_test_count() == tests.test_to_run_count()) {
      std::puts("every test was skipped");
    }
  }
};

[[maybe_unused]] const bool kReportsSkips = [] {
  // the listeners take ownership
  testing::UnitTest::GetInstance()->listeners().Append(new SkipReporter);
  return true;
}();

}  // namespace

// Hooks of the sanitizers' run-time libraries. Mesa keeps tables until exit. Its rasteriser and
// LLVM are not built with the thread sanitizer, which then misses the release of some of their
// locks; hence it ignores both completely, including the locks that LLVM's compiler takes in
// libgcc.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgallium\nleak:swrast_dri.so\nleak:libLLVM\nleak:libEGL\n";
}
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:swrast_dri.so\ncalled_from_lib:libLLVM\n"
         "race:swrast_dri.so\nrace:libLLVM\nmutex:__register_frame_info\n"
         "mutex:__deregister_frame_info\n";
}
