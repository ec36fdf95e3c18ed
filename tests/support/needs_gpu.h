#pragma once

#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"

namespace pleinair::support {

/// Skips, saying why, where no context can be had.
class NeedsGpu : public testing::Test {
 protected:
  void SetUp() override {
    try {
      const gpu::EglContext context;
    } catch (const hal::Failure& error) {
      GTEST_SKIP() << "needs OpenGL ES 3.1: " << error.what();
    }
  }
};

}  // namespace pleinair::support
