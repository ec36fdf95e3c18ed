// The environment of every test, set before main().
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

namespace {

// Makes blending into 32-bit floats a GL error, as on the targets (docs/gpu.md, rule 5).
[[maybe_unused]] const int kFloatBlendForbidden =
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before main(), there is one thread
    setenv("MESA_EXTENSION_OVERRIDE", "-GL_EXT_float_blend", 0);

// Compiling shaders to machine code takes most of the time of a small GPU test (0.3 s per program
// the first time, 10 ms from the cache). The cache lies in the build folder and is removed with it.
[[maybe_unused]] const int kShaderCacheDirectory =
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before main(), there is one thread
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
