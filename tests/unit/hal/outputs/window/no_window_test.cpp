#include <gtest/gtest.h>

#include "hal/outputs/window/window.h"

namespace pleinair::hal {
namespace {

TEST(NoWindow, SaysThatThisBuildHasNoneAndWhatToDo) {
  const auto window = openWindow();
  ASSERT_FALSE(window.has_value());
  EXPECT_EQ(window.error().kind, ErrorKind::kUnsupported);
  EXPECT_NE(window.error().message().find("libsdl2-dev"), std::string::npos);
}

}  // namespace
}  // namespace pleinair::hal
