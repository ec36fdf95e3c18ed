#include <gtest/gtest.h>

#include "firmware_app/status_server/status_server.h"

namespace pleinair::app {
namespace {

TEST(NoStatusServer, SaysSoUnlessItIsOff) {
  EXPECT_EQ(startStatusServer("off", {}), nullptr);
  EXPECT_THROW(startStatusServer("127.0.0.1:0", {}), hal::Failure);
}

}  // namespace
}  // namespace pleinair::app
