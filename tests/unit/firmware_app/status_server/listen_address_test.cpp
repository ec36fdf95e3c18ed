#include "firmware_app/status_server/listen_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

TEST(ListenAddress, ReadsBackWhatItWrites) {
  for (const char* text : {"127.0.0.1:9117", "0.0.0.0:1", "[::1]:65535", "[::]:0"}) {
    const auto address = parseListen(text);
    ASSERT_TRUE(address) << text;
    ASSERT_TRUE(*address);
    EXPECT_EQ(toText(**address), text);
  }
}

TEST(ListenAddress, OffIsNone) {
  const auto address = parseListen("off");
  ASSERT_TRUE(address);
  EXPECT_FALSE(*address);
}

TEST(ListenAddress, RefusesTheRest) {
  for (const char* text : {"", ":", "on", "9117", ":9117", "127.0.0.1", "127.0.0.1:", "localhost:1",
                           "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:+1", "127.0.0.1:80 ",
                           "127.0.0.1:8o", "::1:80", "[::1]", "[127.0.0.1]:1", "256.0.0.1:1"}) {
    const auto address = parseListen(text);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().kind, hal::ErrorKind::kInvalidArgument);
    EXPECT_THAT(address.error().message(), testing::HasSubstr("ADDRESS:PORT"));
  }
}

}  // namespace
}  // namespace pleinair::app
